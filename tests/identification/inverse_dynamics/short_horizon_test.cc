#include "identification/inverse_dynamics/short_horizon.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

// A point on a rod that turns over at first and then swings freely,
//
//   m l² q'' = u − c q' − m g l sin q,
//
// by the classical Runge-Kutta method.
struct TurningOver {
  double mass = 0.4, length = 0.3, damping = 0.02;

  double Acceleration(double q, double v, double u) const {
    return (u - damping * v) / (mass * length * length) - 9.81 / length * std::sin(q);
  }
  std::vector<double> Run(const std::vector<double>& u) const {
    constexpr int kSteps = 50;
    const double h = testing::kPeriod / kSteps;
    std::vector<double> angles;
    double q = 0, v = 0;
    for (const double torque : u) {
      angles.push_back(q);
      for (int k = 0; k < kSteps; ++k) {
        const double a1 = Acceleration(q, v, torque), v2 = v + h / 2 * a1;
        const double a2 = Acceleration(q + h / 2 * v, v2, torque), v3 = v + h / 2 * a2;
        const double a3 = Acceleration(q + h / 2 * v2, v3, torque), v4 = v + h * a3;
        const double a4 = Acceleration(q + h * v3, v4, torque);
        q += h / 6 * (v + 2 * v2 + 2 * v3 + v4), v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      }
    }
    return angles;
  }
};

constexpr char kModel[] = R"(<mujoco>
  <compiler angle="radian"/><option timestep="1e-3" integrator="implicitfast"/>
  <worldbody><body name="bob"><joint name="hinge" axis="0 1 0" damping="0.02"/>
    <inertial pos="0 0 -0.3" mass="0.4" diaginertia="1e-9 1e-9 1e-9"/></body></worldbody>
  <actuator><motor name="servo" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)";

class ShortHorizon : public testing::Bench {
 protected:
  static constexpr double kNoise = 2e-3;

  void SetUp() override {
    Bench::SetUp();
    Write("model.xml", kModel);
    std::vector<double> u;
    for (int k = 0; k < 400; ++k) u.push_back(k < 60 ? 1.6 : k < 90 ? -0.8 : 0);
    AddLog("turns", "use: train", u, testing::Noisy(TurningOver{}.Run(u), kNoise, 0, 1));
  }
  Experiment Heavy(double mass) const {
    return ReadExperiment(
        "parameters:\n  - {name: m, target: 'body:bob', attribute: mass, initial: " +
            std::to_string(mass) + ", lower: 0.05, upper: 3}\n",
        ", sigma: 0.002");
  }
};

TEST_F(ShortHorizon, LeavesTheNoiseAtTheTruthAndLittleMoreWhereAFreeSwingIsLost) {
  const Experiment e = Heavy(0.4);
  const Problem free(e, ModelSpec::Load(e.model));
  const auto use = free.TrainLogs();
  const auto pieces = OnShortHorizons(free, use);
  ASSERT_TRUE(pieces);
  const auto left = [&](const Problem& problem, double mass) {
    return problem.PooledRms(problem.Residuals(Problem::Vector::Constant(1, mass), use), use);
  };
  EXPECT_LT(left(*pieces, 0.4), 5 * kNoise);  // a quartic knows speeds less well
  EXPECT_GT(left(free, 0.8), 2);
  EXPECT_LT(left(*pieces, 0.8), 0.2 * left(free, 0.8));
}

TEST_F(ShortHorizon, LeadsAFitHomeThatEndedTurnsAway) {
  for (const double start : {0.8, 1.2, 1.6, 2.4}) {
    const Experiment e = Heavy(start);
    const Problem problem(e, ModelSpec::Load(e.model));
    const auto use = problem.TrainLogs();
    const Fit lost = FitParameters(problem, problem.Start(), use);
    ASSERT_GT(std::abs(lost.x[0] - 0.4), 0.1) << start;
    const Fit home = FitByShortHorizons(problem, lost, use, {});
    EXPECT_NEAR(home.x[0], 0.4, 2e-3) << start;
    EXPECT_TRUE(home.anew);
    EXPECT_LT(home.cost, 1e-3 * lost.cost);
    EXPECT_GT(home.evaluations, lost.evaluations);
  }
}

TEST_F(ShortHorizon, LeavesAFitAsItIsThatLeavesLittleMoreThanNoise) {
  const Experiment e = Heavy(0.39);
  const Problem problem(e, ModelSpec::Load(e.model));
  const auto use = problem.TrainLogs();
  const Fit fit = FitParameters(problem, problem.Start(), use);
  EXPECT_EQ(FitByShortHorizons(problem, fit, use, {}).evaluations, fit.evaluations);
}

TEST_F(ShortHorizon, IsNoneWhereAJointIsNotMeasured) {
  std::string model = kModel;
  model.insert(model.find("</body>"), "<body><joint name='loose'/><geom size='0.01'/></body>");
  Write("model.xml", model);
  const Experiment e = Heavy(0.4);
  const Problem problem(e, ModelSpec::Load(e.model));
  EXPECT_FALSE(OnShortHorizons(problem, problem.TrainLogs()));
}

}  // namespace
}  // namespace continuum
