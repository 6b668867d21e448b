#include "models/solve.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "error.h"
#include "sim/io/csv.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// What all three robots do alike with --compliance, --reach and --sweep.
class SolveRequests : public ::testing::Test {
 protected:
  SolveRequests() {
    request_.out = folder_ / "out.csv";
    request_.say = [&](const std::string& text) { said_ += text; };
  }

  void Take(const std::string& robot, const std::string& cases) {
    request_.robot = std::string(CONTINUUM_SOURCE "/models/") + robot;
    request_.input = folder_.Write("cases.csv", cases);
  }
  CsvTable Out() const { return CsvTable::Read(request_.out); }

  testing::Scratch folder_;
  SolveRequest request_;
  std::string said_;
};

const std::pair<const char*, const char*> kCases[] = {
    {"tdcr/tdcr.yaml", "case,T1,T2,T3,fx,fy,fz\na,3,0.5,1,0.01,0,0\n"},
    {"twin_pivot/a.yaml", "case,F1,F2,F3,F4,fx\na,3,4,1,2,0.02\n"},
    {"stiff_flop/stiff_flop.yaml", "case,p1,p2,p3,fx\na,20e3,10e3,0,0.02\n"}};

TEST_F(SolveRequests, WriteARowForEveryInputAndTheEllipsoids) {
  const char* const last[] = {"T3", "F4", "p3"};
  for (int i = 0; i < 3; ++i) {
    Take(kCases[i].first, kCases[i].second);
    request_.compliance = folder_ / "c.csv";
    EXPECT_EQ(Solve(request_), 0);
    const CsvTable table = CsvTable::Read(request_.compliance);
    const std::size_t rows = table.rows();
    EXPECT_EQ(table.Text(0, "by"), "fx");
    EXPECT_EQ(table.Text(rows - 7, "by"), last[i]);
    EXPECT_EQ(table.Text(rows - 1, "by"), "drive_3");
    EXPECT_GT(table.Number(0, "x"), 0);  // a tip gives way to a push
  }
}

TEST_F(SolveRequests, ReachTheTipsOfOtherCases) {
  for (const auto& [robot, cases] : kCases) {
    Take(robot, cases);
    request_.reach.clear();
    EXPECT_EQ(Solve(request_), 0);
    const CsvTable made = Out();
    const auto cell = [&](const char* axis) { return made.Text(0, axis); };
    request_.reach = folder_.Write(
        "targets.csv", "case,x,y,z\na," + cell("x") + "," + cell("y") + "," + cell("z") + "\n");
    EXPECT_EQ(Solve(request_), 0);
    for (const char* axis : {"x", "y", "z"}) {
      EXPECT_NEAR(Out().Number(0, axis), made.Number(0, axis), 2e-7) << robot;
    }
    EXPECT_LT(Out().Number(0, "miss"), 2e-7);
    EXPECT_THAT(said_, HasSubstr("1 targets"));
  }
}

// One table would take the place of the other, and none would say so.
TEST_F(SolveRequests, RefuseTwoOutputsInOneFile) {
  for (const auto& [robot, cases] : kCases) {
    Take(robot, cases);
    request_.compliance = folder_ / "./out.csv";
    EXPECT_THAT([&] { Solve(request_); },
                ThrowsMessage<Error>(HasSubstr("expected a file of its")));
    EXPECT_FALSE(std::filesystem::exists(request_.out));
    request_.shape = folder_ / "line.csv";
    request_.compliance = request_.shape;
    EXPECT_THAT([&] { Solve(request_); }, ThrowsMessage<Error>(HasSubstr("line.csv: expected")));
    request_.shape.clear();
  }
}

// What is missing is named, not what is left of its kind.
TEST_F(SolveRequests, NameTheColumnThatIsMissing) {
  const std::pair<const char*, const char*> lacking[] = {
      {"tdcr/tdcr.yaml", "case,T2,T3,fx,fy,fz\na,1,1,0,0,0\n"},
      {"tdcr/tdcr.yaml", "case,L2,L3,fx,fy,fz\na,1,1,0,0,0\n"},
      {"twin_pivot/a.yaml", "case,F2,F3,F4\na,1,1,1\n"},
      {"twin_pivot/a.yaml", "case,m2,m3,m4\na,1,1,1\n"},
      {"twin_pivot/a.yaml", "case,L2,L3,L4\na,1,1,1\n"},
      {"annelida/annelida.yaml", "case,F2,F3,F4\na,1,1,1\n"},
      {"annelida/annelida.yaml", "case,L2,L3,L4\na,1,1,1\n"}};
  for (const auto& [robot, cases] : lacking) {
    Take(robot, cases);
    const std::string missing = {cases[5], '1'};
    EXPECT_THAT([&] { Solve(request_); },
                ThrowsMessage<Error>(HasSubstr("cases.csv:1: expected a column '" + missing)))
        << cases;
  }
}

// Pressures without a limit have no farthest place.
TEST_F(SolveRequests, SayWhatIsOutOfReach) {
  const char* const limits[] = {"", "", "60e3"};
  for (int i = 0; i < 3; ++i) {
    Take(kCases[i].first, kCases[i].second);
    const std::string high = limits[i];
    request_.reach =
        folder_.Write("targets.csv", high.empty() ? "case,x,y,z\na,1,1,1\n"
                                                  : "case,x,y,z,high\na,1,1,1," + high + "\n");
    EXPECT_EQ(Solve(request_), 1);
    EXPECT_EQ(Out().Text(0, "status"), "out_of_reach");
    EXPECT_THAT(Out().Text(0, "why"), HasSubstr("out of reach"));
    EXPECT_EQ(Out().Text(0, "x"), "");
  }
}

TEST_F(SolveRequests, FollowAPathAndPrintItsError) {
  Take("twin_pivot/a.yaml", "case,F1,F2,F3,F4,reference\na,2,2,1,1,\nb,2,2,1,1,a\nc,2,2,1,1,b\n");
  request_.reach =
      folder_.Write("targets.csv", "case,y,z\na,0.012,0\nb,0.012,0.002\nc,0.013,0.004\n");
  EXPECT_EQ(Solve(request_), 0) << CsvTable::Read(request_.out).Text(0, "why");
  EXPECT_THAT(said_, HasSubstr("3 targets"));
  EXPECT_THAT(said_, HasSubstr("halfway between two"));
}

TEST_F(SolveRequests, SweepTheGridBetweenTwoRows) {
  Take("tdcr/tdcr.yaml", "case,T1,T2,T3,fx,fy,fz\nlow,0,0,0,0,0,0\nhigh,4,4,0,0,0,0\n");
  request_.sweep = 5;
  EXPECT_EQ(Solve(request_), 0);
  EXPECT_EQ(Out().rows(), 25U);
  EXPECT_EQ(Out().Number(0, "x"), 0);
  EXPECT_GT(Out().Number(20, "x"), 0.05);
}

}  // namespace
}  // namespace continuum
