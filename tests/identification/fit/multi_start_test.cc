#include "identification/fit/multi_start.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "error.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Pendulum;

// A pendulum that rings at 2 Hz after a jump, and a bob ten times too heavy to start with: cost has
// a valley for every period that the model may be behind.
class MultiStartTest : public testing::Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    truth_.damping = 0.01;
    const std::vector<double> jump(200, 0.4);
    AddLog("ringing", "use: train", jump, truth_.Run(jump, testing::kPeriod));
    experiment_ = ReadExperiment(
        "parameters:\n"
        "  - {name: bob, target: 'body:arm', attribute: mass, initial: 3, lower: 0.1, upper: 3}\n");
  }
  Problem Ringing(const std::string& bounds = "") {
    if (!bounds.empty()) experiment_ = ReadExperiment("parameters:\n" + bounds);
    return {experiment_, ModelSpec::Load(Write("model.xml", truth_.Xml("", 1e-3)))};
  }

  Pendulum truth_;
  Experiment experiment_;
};

TEST_F(MultiStartTest, FindsWhatOneStartMisses) {
  const Problem problem = Ringing();
  const Fit one = FitParameters(problem, problem.Start(), problem.TrainLogs());
  EXPECT_GT(std::abs(one.x[0] - truth_.bob), 0.5 * truth_.bob);
  const MultiStart many = FitFromMany(problem, problem.Start(), problem.TrainLogs(), 12, 1);
  EXPECT_NEAR(many.best.x[0], truth_.bob, 0.02 * truth_.bob);
  EXPECT_LT(many.best.cost, 0.05 * one.cost);
  ASSERT_EQ(many.starts.size(), 12u);
  EXPECT_EQ(many.starts[0].x, problem.Start());
  EXPECT_GE(many.Reached(), 1u);
  EXPECT_LT(many.Reached(), 12u);
}

TEST_F(MultiStartTest, RepeatsForASeedAndOtherwiseNot) {
  const Problem problem = Ringing();
  const auto first = FitFromMany(problem, problem.Start(), problem.TrainLogs(), 3, 7);
  const auto again = FitFromMany(problem, problem.Start(), problem.TrainLogs(), 3, 7);
  const auto other = FitFromMany(problem, problem.Start(), problem.TrainLogs(), 3, 8);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(first.starts[k].x, again.starts[k].x);
    EXPECT_EQ(first.starts[k].cost, again.starts[k].cost);
    EXPECT_EQ(first.starts[k].x == other.starts[k].x, k == 0);
  }
  EXPECT_EQ(first.best.x, again.best.x);
}

TEST_F(MultiStartTest, StartsSpreadInEqualRatiosOverWideBounds) {
  const Problem problem = Ringing();
  FitOptions options;
  options.iterations = 1;
  int small = 0;
  for (const Start& start :
       FitFromMany(problem, problem.Start(), problem.TrainLogs(), 40, 3, options).starts) {
    EXPECT_GE(start.x[0], 0.1);
    EXPECT_LE(start.x[0], 3);
    small += start.x[0] < 0.55;  // the middle of the ratios
  }
  EXPECT_NEAR(small, 20, 10);
}

TEST_F(MultiStartTest, AParameterWithoutEffectIsRefusedAsFromOneStart) {
  const Problem problem = Ringing(
      "  - {name: east, target: option, attribute: 'gravity[1]', initial: 0, lower: -1, upper: "
      "1}\n");
  EXPECT_THROW(FitFromMany(problem, problem.Start(), problem.TrainLogs(), 3, 1), Error);
}

}  // namespace
}  // namespace continuum
