#include "identification/inverse_dynamics/equation_error_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/wheel.h"

namespace continuum {
namespace {

// It rings for long after steps of torque: out of step from the first swings on, a simulation fits
// best when it hardly moves.
struct Ringing : testing::Wheel {
  Ringing() : Wheel{0.8, 120, 0.4} {}

  static std::vector<double> Steps() {
    std::vector<double> u;
    for (int k = 0; k < 800; ++k) u.push_back(k < 30 ? 0 : k % 400 < 200 ? 20 : -15);
    return u;
  }
};

constexpr char kModel[] = R"(<mujoco>
  <option timestep="2e-3" integrator="implicitfast"/>
  <worldbody><body><joint name="hinge" stiffness="40" damping="1" armature="2.4"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
  <actuator><motor name="servo" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)";

constexpr char kParameters[] =
    "parameters:\n"
    "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 30, lower: 10, "
    "upper: 900}\n"
    "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.1, lower: 0.01, "
    "upper: 20}\n"
    "  - {name: j, target: 'joint:hinge', attribute: armature, initial: 2.4, lower: 0.1, "
    "upper: 10}\n";

class EquationFitTest : public testing::Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    const auto u = Ringing::Steps();
    AddLog("ringing", "use: train", u, testing::Noisy(Ringing{}.Run(u), 1e-3, 0, 1));
  }
};

TEST_F(EquationFitTest, IsNearFromFarAwayAlthoughInertiasMultiplyNoise) {
  const Experiment experiment = ReadExperiment(kParameters);
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const auto found = FitEquations(problem, problem.Start(), problem.TrainLogs());
  ASSERT_TRUE(found);
  const Ringing truth;
  EXPECT_NEAR(found->x[0], truth.stiffness, 0.03 * truth.stiffness);
  EXPECT_NEAR(found->x[1], truth.damping, 0.5 * truth.damping);
  EXPECT_NEAR(found->x[2], truth.inertia, 0.03 * truth.inertia);
  EXPECT_GT(found->evaluations, 8u);
}

TEST_F(EquationFitTest, LeadsAFitThatEndedInAWrongPlaceHome) {
  const Experiment experiment = ReadExperiment(kParameters);
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const auto use = problem.TrainLogs();
  const Fit lost = FitParameters(problem, problem.Start(), use);
  EXPECT_EQ(lost.x[1], 20) << "at its bound";
  const Fit home = FitByEquations(problem, lost, use, {});
  EXPECT_LT(home.cost, 1e-3 * lost.cost);
  EXPECT_TRUE(home.anew);
  EXPECT_NEAR(home.x[0], 120, 0.6);
  EXPECT_NEAR(home.x[2], 0.8, 0.004);
  EXPECT_GT(home.evaluations, lost.evaluations);
  EXPECT_EQ(std::ssize(home.trace), home.iterations + 1);
}

TEST_F(EquationFitTest, LeavesAFitAsItIsThatLeavesLittleMoreThanNoise) {
  const Experiment experiment = ReadExperiment(kParameters);
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const auto use = problem.TrainLogs();
  Problem::Vector near = problem.Start();
  near << 118, 0.5, 0.8;
  const Fit fit = FitParameters(problem, near, use);
  const Fit same = FitByEquations(problem, fit, use, {});
  EXPECT_EQ(same.evaluations, fit.evaluations);
  EXPECT_FALSE(same.anew);
}

TEST_F(EquationFitTest, UnderARobustLossOutliersAreNotWhatIsLeft) {
  const auto u = Ringing::Steps();
  auto q = testing::Noisy(Ringing{}.Run(u), 1e-3, 0, 2);
  for (std::size_t k = 20; k < q.size(); k += 100) q[k] += 0.5;
  AddLog("outliers", "use: validate", u, q);
  const Experiment experiment =
      ReadExperiment(std::string("loss: {soft_l1: 0.01}\n") + kParameters);
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const std::vector<bool> use{false, true};
  FitOptions robust;
  robust.soft = experiment.soft;
  const Fit fit = FitParameters(problem, problem.Start(), use, robust);
  EXPECT_NEAR(fit.x[0], 120, 0.6);
  const auto r = problem.Residuals(fit.x, use);
  EXPECT_LT(TypicalRms(problem, r, use), 0.2 * problem.PooledRms(r, use));
}

TEST_F(EquationFitTest, TakesNoMoreIterationsThanAreLeft) {
  const Experiment experiment = ReadExperiment(kParameters);
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const auto use = problem.TrainLogs();
  const Fit lost = FitParameters(problem, problem.Start(), use);
  EXPECT_FALSE(FitByEquations(problem, lost, use, {.iterations = lost.iterations}).anew);
  const Fit home = FitByEquations(problem, lost, use, {.iterations = lost.iterations + 2});
  EXPECT_TRUE(home.anew);
  EXPECT_LE(home.iterations, 2);
}

TEST_F(EquationFitTest, LooksAtLogsInWhichEveryRowIsMeasured) {
  const auto u = Ringing::Steps();
  auto q = Ringing{}.Run(u);
  q[100] = std::nan("");
  AddLog("gap", "use: train", u, q);
  const Experiment experiment = ReadExperiment(kParameters);
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const auto found = FitEquations(problem, problem.Start(), problem.TrainLogs());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x[0], 120, 4);
  EXPECT_FALSE(FitEquations(problem, problem.Start(), {false, true}));
}

}  // namespace
}  // namespace continuum
