#include "identification/fit/multiple_shooting.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Pendulum;

constexpr const char* kSpring =
    "parameters:\n"
    "  - {name: kp, target: 'actuator:servo', attribute: kp, initial: 6.5, lower: 1, upper: 20}\n";

// A pendulum that rings after each move of its servo, four times a second.
class PiecesTest : public Bench {
 protected:
  Experiment Ringing(double seconds, const std::string& parameters = kSpring) {
    Pendulum truth;
    truth.damping = 0.004;
    std::vector<double> u;
    for (double t = 0; t < seconds; t += testing::kPeriod)
      u.push_back(std::fmod(t, 14) < 7 ? 0 : 1);
    AddLog("ringing", "use: train", u, testing::Noisy(truth.Run(u, testing::kPeriod), 2e-3, 0, 1));
    return ReadExperiment(parameters);
  }
  ModelSpec Model() {
    Pendulum model;
    model.damping = 0.004;
    return ModelSpec::Load(Write("model.xml", model.Xml()));
  }
};

TEST_F(PiecesTest, WhereALongLogFallsOutOfStepItsPiecesLeadToTheTruth) {
  CONTINUUM_LONG_IF_SANITIZED("several fits");
  const Experiment e = Ringing(30);
  const ModelSpec system = Model();
  const Problem problem(e, system);
  const auto use = problem.TrainLogs();
  const Fit alone = FitParameters(problem, problem.Start(), use);
  EXPECT_GT(std::abs(alone.x[0] - 5), 0.5) << "what the segments are for";
  const auto segments = FitByMultipleShooting(problem, problem.Start(), use, {});
  ASSERT_TRUE(segments);
  EXPECT_LT(segments->after, 0.1 * segments->before);
  EXPECT_GT(segments->evaluations, 16u);
  const Fit fit = FitParameters(problem, segments->x, use);
  EXPECT_NEAR(fit.x[0], 5, 0.02);
  EXPECT_LT(fit.cost, 0.01 * alone.cost);
}

TEST_F(PiecesTest, HeavySeamsMakeTwoPiecesOneMotion) {
  Experiment e = Ringing(6);
  const Log log = e.logs[0];
  constexpr std::size_t kShared = 10;
  e.logs = {SegmentOf(log, 0, 300 + kShared - 1), SegmentOf(log, 300, log.rows() - 1)};
  e.logs[1].label = "second";
  e.start = Experiment::Start::kEstimate;
  const ModelSpec system = Model();
  const Problem problem(e, system);
  const auto use = problem.AllLogs();
  const auto gap = [&](double weight) {
    FitOptions options;
    options.continuity = {{0, 1, kShared}}, options.continuity_weight = weight;
    const auto r = problem.Residuals(FitParameters(problem, problem.Start(), use, options).x, use);
    return (r[0].tail(kShared) - r[1].head(kShared)).norm();
  };
  const double apart = gap(0);
  EXPECT_GT(apart, 0);
  EXPECT_LT(gap(1000), 0.01 * apart);
}

TEST_F(PiecesTest, ShortLogsAreNotCut) {
  const Experiment e = Ringing(19);
  const Problem problem(e, Model());
  EXPECT_FALSE(FitByMultipleShooting(problem, problem.Start(), problem.TrainLogs(), {}));
}

TEST_F(PiecesTest, NorLogsWithValuesOfTheirOwn) {
  const Experiment e = Ringing(30, std::string(kSpring) +
                                       "  - {name: b, target: 'joint:hinge', attribute: damping, "
                                       "initial: 0.01, lower: 0.001, upper: 1, per: log}\n");
  const Problem problem(e, Model());
  EXPECT_FALSE(FitByMultipleShooting(problem, problem.Start(), problem.TrainLogs(), {}));
}

}  // namespace
}  // namespace continuum
