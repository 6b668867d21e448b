#include "identification/inverse_dynamics/fit_by_steps.h"

#include <gtest/gtest.h>

#include "identification/problem/path_choice.h"
#include "support/wheel.h"

namespace continuum {
namespace {

// Turned to and fro by steps of torque, and held again by friction; the log is of an integrator of
// its own.
class FitByStepsTest : public testing::Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    Write("model.xml", R"(<mujoco>
  <extension><plugin plugin="continuum.coulomb"><instance name="law">
    <config key="joint" value="hinge"/><config key="tau_c" value="1"/></instance></plugin></extension>
  <option timestep="2e-3" integrator="implicitfast"/>
  <worldbody><body><joint name="hinge" stiffness="40" damping="1" armature="0.8"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
  <actuator><motor name="servo" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)");
    const std::vector<double> u = testing::ToAndFro();
    AddLog("shaken", "use: train", u,
           testing::Noisy(testing::Wheel{1.2, 60, 1.5, 2}.Run(u), 1e-4, 0, 1));
    experiment_ = ReadExperiment(
        "parameters:\n"
        "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 20, lower: 1, "
        "upper: 300}\n"
        "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 5, lower: 0.01, "
        "upper: 20}\n"
        "  - {name: j, target: 'joint:hinge', attribute: armature, initial: 6, lower: 0.1, "
        "upper: 10}\n"
        "  - {name: fc, target: 'plugin:law', attribute: tau_c, initial: 0.1, lower: 0, "
        "upper: 6}\n");
  }
  Experiment experiment_;
};

TEST_F(FitByStepsTest, BeginsNearAMachineThatSticks) {
  Problem problem(experiment_, ModelSpec::Load(folder_ / "model.xml"));
  ASSERT_EQ(SmoothObstacle(problem), "");
  problem.Follow(Path::kSmooth);
  const Fit fit = FitBySteps(problem, problem.Start(), problem.TrainLogs(), 1, {});
  const double truth[] = {60, 1.5, 1.2, 2};
  for (Eigen::Index i = 0; i < 4; ++i) EXPECT_NEAR(fit.x[i], truth[i], 0.01 * truth[i]) << i;
  EXPECT_GT(fit.evaluations, 0u);
  EXPECT_GT(fit.seconds, 0);
  const Fit smooth = FitParameters(problem, fit.x, problem.TrainLogs());
  for (Eigen::Index i = 0; i < 4; ++i) EXPECT_NEAR(smooth.x[i], truth[i], 0.01 * truth[i]) << i;
}

}  // namespace
}  // namespace continuum
