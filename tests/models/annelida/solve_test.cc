#include "models/annelida/solve.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/solve.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string kYaml = std::string(CONTINUUM_SOURCE) + "/models/annelida/annelida.yaml";

class SolveAnnelidaTest : public ::testing::Test {
 protected:
  SolveAnnelidaTest() {
    request_.robot = kYaml;
    request_.out = folder_ / "out.csv";
    request_.warn = [&](const std::string& text) { warned_ += text + '\n'; };
  }
  CsvTable Out(const std::string& cases, const std::string& method = "", int code = 0) {
    request_.input = folder_.Write("cases.csv", cases);
    request_.method = method;
    EXPECT_EQ(Solve(request_), code);
    return CsvTable::Read(request_.out);
  }
  void ExpectRefused(const std::string& cases, const std::string& expected,
                     const std::string& found) {
    request_.input = folder_.Write("cases.csv", cases);
    EXPECT_THAT([&] { Solve(request_); },
                ThrowsMessage<Error>(
                    AllOf(HasSubstr("cases.csv:"), HasSubstr(expected), HasSubstr(found))));
  }

  testing::Scratch folder_;
  SolveRequest request_;
  std::string warned_;
};

TEST_F(SolveAnnelidaTest, EveryMethodBendsTowardThePulledCable) {
  for (const char* method : {"", "constant_curvature", "chain", "chain_friction"}) {
    const CsvTable out = Out("case,F1,F2,F3,F4\nrest,0,0,0,0\nx,15,0,0,0\ny,0,15,0,0\n", method);
    EXPECT_NEAR(out.Number(0, "z"), 0.26, 1e-12);
    EXPECT_GT(out.Number(1, "x"), 0.05);
    EXPECT_NEAR(out.Number(1, "y"), 0, 1e-10);
    EXPECT_GT(out.Number(2, "y"), 0.05);
    EXPECT_EQ(out.Text(2, "status"), "ok");
  }
  EXPECT_EQ(warned_, "");
}

TEST_F(SolveAnnelidaTest, LengthsOfAnAnswerGiveItsShape) {
  request_.robot = folder_.Write("arm.yaml", ReadFile(kYaml) + "sections: [3, 3]\n");
  const CsvTable pulled = Out("case,F1,F2,F3,F4,F5,F6,F7,F8\na,6,0,0,2,0,9,0,0\n");
  std::string header = "case", row = "a";
  for (int j = 1; j <= 8; ++j) {
    header += ",L" + std::to_string(j);
    row += "," + pulled.Text(0, "l_" + std::to_string(j));
  }
  const CsvTable by_length = Out(header + '\n' + row + '\n');
  for (const char* column : {"x", "y", "z", "angle_1", "angle_2", "azimuth_2", "curvature_2"}) {
    EXPECT_NEAR(by_length.Number(0, column), pulled.Number(0, column), 1e-10) << column;
  }
  EXPECT_LT(by_length.Number(0, "mismatch"), 1e-12);
}

TEST_F(SolveAnnelidaTest, SaysWhatIsUnstableOrBeyondTheStops) {
  EXPECT_EQ(Out("case,F1,F2,F3,F4\na,100,100,100,100\n", "chain", 1).Text(0, "status"), "saddle");
  EXPECT_EQ(warned_, "");
  Out("case,F1,F2,F3,F4\nfar,28,0,0,0\n", "chain");
  EXPECT_THAT(warned_, AllOf(HasSubstr("0.651"), HasSubstr("'far'"), HasSubstr("1 of 1")));
}

TEST_F(SolveAnnelidaTest, DrawsTheShapes) {
  request_.plot = folder_ / "shapes.svg";
  Out("case,F1,F2,F3,F4\na,15,0,0,0\nb,0,10,10,0\n", "chain");
  EXPECT_THAT(ReadFile(request_.plot), HasSubstr("annelida.yaml"));
}

TEST_F(SolveAnnelidaTest, SweepsAndAnswersStreams) {
  request_.sweep = 3;
  EXPECT_EQ(Out("case,F1,F2,F3,F4\na,0,0,0,0\nb,10,10,0,0\n").rows(), 9U);
}

TEST_F(SolveAnnelidaTest, RefusesBadTables) {
  ExpectRefused("case,F1,F2,F3\na,1,1,1\n", "F4", "");
  ExpectRefused("case,F1,F2,F3,F4\na,1,1,1,-2\n", "'F4'", "-2");
  ExpectRefused("case,F1,F2,F3,F4,mass\na,1,1,1,2,1\n", "fx, fy, fz", "mass");
  ExpectRefused("case,F1,F2,F3,F4\na,1,1,1,1\na,1,1,1,1\n", "no other case", "'a'");
  request_.method = "chain";
  ExpectRefused("case,L1,L2,L3,L4\na,.26,.26,.26,.26\n", "tensions F1", "'L1'");
  request_.method = "arc";
  EXPECT_THAT([&] { Solve(request_); },
              ThrowsMessage<Error>(AllOf(HasSubstr("--method"), HasSubstr("chain_friction"))));
  request_.method = "";
  request_.calibrate = true;
  EXPECT_THAT([&] { Solve(request_); }, ThrowsMessage<Error>(HasSubstr("--calibrate")));
}

}  // namespace
}  // namespace continuum
