#include "identification/study/population.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/study/summary.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class Units : public ::testing::Test {
 protected:
  Units() { table_.rows.reserve(100); }
  void Add(const std::string& name, const std::string& model, const RowParameter& p) {
    table_.rows.push_back({table_.rows.size() + 1, "s.csv:1", name, "arm.yaml", "identify"});
    StudyLine line{&table_.rows.back(), {}, {}};
    line.status.state = RowStatus::State::kDone;
    line.status.record = RowRecord{};
    line.status.record->inputs.model = model;
    line.result.verdict = "converged";
    line.result.parameters.push_back(p);
    lines_.push_back(line);
  }
  // Known to 1 %.
  void AddArm(double damping) {
    Add("arm_" + std::to_string(lines_.size()), "robots/arm.xml",
        {"damping", "N*m*s/rad", damping, damping - 0.01, damping + 0.01, false});
  }
  StudyTable table_;
  std::vector<StudyLine> lines_;
};

TEST_F(Units, OfOneModelAndParameterBelongTogether) {
  for (const double d : {1.0, 1.1, 0.95}) AddArm(d);
  Add("other", "robots/leg.xml", {"damping", "N*m*s/rad", 2, 1.9, 2.1, false});
  Add("mass", "robots/arm.xml", {"mass", "kg", 2, 1.9, 2.1, false});
  const auto all = PopulationsOf(lines_);
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(all[0].model, "arm.xml");
  EXPECT_THAT(all[0].units, SizeIs(3));
  EXPECT_NEAR(all[0].spread.mean, 3.05 / 3, 1e-3);
  EXPECT_THAT(OddUnits(all[0], lines_), ElementsAre());
}

TEST_F(Units, WithoutAnIntervalOrAtABoundAreLeftOut) {
  for (const double d : {1.0, 1.1, 0.95}) AddArm(d);
  Add("bound", "arm.xml", {"damping", "N*m*s/rad", 5, 4.9, 5.1, true});
  Add("unknown", "arm.xml", {"damping", "N*m*s/rad", 5, NAN, NAN, false});
  const auto all = PopulationsOf(lines_);
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_THAT(all[0].units, SizeIs(3));
  EXPECT_THAT(all[0].left_out, ElementsAre(3, 4));
}

TEST_F(Units, TheOddOneIsNamedInEverySummary) {
  for (int i = 0; i < 20; ++i) AddArm(1 + 0.02 * std::sin(3 * i));
  AddArm(1.5);
  const StudySummary summary{&table_, lines_, PopulationsOf(lines_)};
  EXPECT_THAT(OddUnits(summary.populations[0], lines_), ElementsAre("arm_20"));
  EXPECT_THAT(SummaryJson(summary), HasSubstr("\"odd\": [\n        \"arm_20\"\n      ]"));
  EXPECT_THAT(SummaryCsv(summary), HasSubstr("damping [N*m*s/rad] low"));
}

TEST_F(Units, StartsOfTrialsAreNone) {
  for (int i = 0; i < 3; ++i) Add("a" + std::to_string(i), "m", {"start:q", "rad", 1, 0, 2, false});
  EXPECT_TRUE(PopulationsOf(lines_).empty());
}

}  // namespace
}  // namespace continuum
