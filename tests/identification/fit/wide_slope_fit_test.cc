#include "identification/fit/wide_slope_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/long_test.h"
#include "support/pendulum_fit.h"
#include "support/wheel.h"

namespace continuum {
namespace {

// Shaken by steps of torque and held again by friction: where it comes to rest changes by leaps
// with every parameter.
struct Shaken : testing::Wheel {
  Shaken() : Wheel{1.2, 60, 1.5, 2} {}

  static std::vector<double> Steps() { return testing::ToAndFro(500); }
};

constexpr char kModel[] = R"(<mujoco>
  <option timestep="2e-3" integrator="implicitfast"/>
  <extension>
    <plugin plugin="continuum.coulomb"><instance name="dry"><config key="joint" value="hinge"/>
      <config key="tau_c" value="1"/></instance></plugin>
  </extension>
  <worldbody><body><joint name="hinge" stiffness="40" damping="1" armature="0.8"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
  <actuator><motor name="servo" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)";

class Far : public testing::Bench {};
using testing::FitTest;

TEST_F(Far, LeavesTheValleyWhereFittingAlongSlopesEnds) {
  CONTINUUM_LONG_IF_SANITIZED("several fits");
  const Shaken truth;
  const auto u = Shaken::Steps();
  AddLog("shaken", "use: train", u, testing::Noisy(truth.Run(u), 1e-4, 0, 1));
  const Experiment experiment = ReadExperiment(
      "parameters:\n"
      "  - {name: fc, target: 'plugin:dry', attribute: tau_c, initial: 1, lower: 0, upper: 6}\n"
      "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 40, lower: 1, "
      "upper: 300}\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 1, lower: 0.01, "
      "upper: 20}\n"
      "  - {name: j, target: 'joint:hinge', attribute: armature, initial: 0.8, lower: 0.1, "
      "upper: 10}\n");
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  const auto logs = problem.TrainLogs();
  const Fit near = FitParameters(problem, problem.Start(), logs);
  const Fit far = FitWithWideSlopes(problem, problem.Start(), logs);
  EXPECT_LT(far.cost, 0.01 * near.cost);
  const double expected[] = {truth.tau_c, truth.stiffness, truth.damping, truth.inertia};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(far.x[k], expected[k], 0.02 * expected[k]) << k;
  EXPECT_GT(far.evaluations, near.evaluations);
}

TEST_F(Far, TakesNoMoreIterationsThanAllowedAndTracesEach) {
  const auto u = Shaken::Steps();
  AddLog("shaken", "use: train", u, testing::Noisy(Shaken().Run(u), 1e-4, 0, 1));
  const Experiment experiment = ReadExperiment(
      "parameters:\n"
      "  - {name: fc, target: 'plugin:dry', attribute: tau_c, initial: 1, lower: 0, upper: 6}\n"
      "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 40, lower: 1, "
      "upper: 300}\n");
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  for (const int most : {1, 4, 8, 50}) {
    const Fit fit =
        FitWithWideSlopes(problem, problem.Start(), problem.TrainLogs(), {.iterations = most});
    EXPECT_LE(fit.iterations, most);
    EXPECT_EQ(std::ssize(fit.trace), fit.iterations + 1) << most;
    EXPECT_EQ(fit.trace.back(), fit.cost) << most;
    EXPECT_TRUE(std::is_sorted(fit.trace.rbegin(), fit.trace.rend())) << most;
  }
}

// A fifth of such a size is where nothing can be simulated.
TEST_F(FitTest, KeepsAFitWhereWideSlopesDiverge) {
  const testing::Pendulum truth;
  AddTrials(truth, 1, 1e-3);
  const ModelSpec system = Model({});
  const Experiment e = ReadExperiment(
      "parameters:\n  - {name: m, target: 'body:arm', attribute: mass, initial: 0.2, lower: 1e-9, "
      "upper: 1e12}\n" +
      testing::kDamping);
  const Problem problem(e, system);
  const Fit fit = FitWithWideSlopes(problem, problem.Start(), problem.TrainLogs());
  EXPECT_NEAR(fit.x[1], truth.damping, 0.1 * truth.damping) << fit.message;
}

TEST_F(Far, HasNothingToFitWithoutParameters) {
  const auto u = Shaken::Steps();
  AddLog("shaken", "use: train", u, Shaken().Run(u));
  const Experiment experiment = ReadExperiment("");
  const Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  EXPECT_EQ(FitWithWideSlopes(problem, problem.Start(), problem.TrainLogs()).x.size(), 0);
}

}  // namespace
}  // namespace continuum
