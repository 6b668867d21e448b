#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

#include "models/twin_pivot/again.h"
#include "models/twin_pivot/bench.h"

namespace continuum::twin_pivot {
namespace {

using again::Bodies;
using again::Body;
using again::Discs;
using again::EnergySlope;
using Eigen::MatrixXd;

class BalanceOfPrototype : public EveryPrototype {};
INSTANTIATE_TEST_SUITE_P(TwinPivot, BalanceOfPrototype, testing::Values("a", "b", "c"));

TEST_P(BalanceOfPrototype, VirtualWorkIsTheSlopeOfTheEnergyWithoutFriction) {
  robot_.friction = {};
  load_.payload = 0.02;
  load_.force = {0.05, -0.1, 0.2};
  load_.gravity = {3, -8, 4};
  const VectorXd beta = Random(n_, 0.3, 4);
  const auto f = Residual(robot_, load_, Method::kVirtualWork, beta);
  ASSERT_TRUE(f);
  EXPECT_LT((*f + EnergySlope(robot_, load_, beta)).norm(), 1e-11);
}

TEST_P(BalanceOfPrototype, SolutionWithoutFrictionIsStationaryInEnergy) {
  load_.condition = Condition::kI;
  load_.force = {0.05, -0.1, 0.2};
  const Solution solution = Solve(robot_, load_);
  ASSERT_TRUE(solution.outcome.ok());
  EXPECT_LT(EnergySlope(robot_, load_, solution.beta).norm(), 1e-11);
}

TEST_P(BalanceOfPrototype, MomentAtTheTipWorksOnTheTurnOfTheTip) {
  const VectorXd beta = Random(n_, 0.3, 5);
  Load loaded = load_;
  loaded.moment = {1e-3, -2e-3, 3e-3};
  for (const Method method : {Method::kVirtualWork, Method::kPrinted}) {
    const VectorXd by_moment =
        *Residual(robot_, loaded, method, beta) - *Residual(robot_, load_, method, beta);
    const auto disc = Discs(robot_, beta);
    for (int m = 0; m < n_; ++m) {
      const Vector3d axis = disc[m].block<3, 1>(0, 2);
      EXPECT_NEAR(by_moment[m], loaded.moment.dot(axis), 1e-16);
    }
  }
}

TEST_P(BalanceOfPrototype, PrintedBalanceTakesMomentsAboutTheProximalDisc) {
  robot_.friction = {};
  load_.force = {0.05, -0.1, 0.2};
  const VectorXd beta = Random(n_, 0.3, 6);
  const auto disc = Discs(robot_, beta);
  const Vector3d tip = disc.back().topRightCorner<3, 1>();
  const VectorXd f = *Residual(robot_, load_, Method::kPrinted, beta);
  for (int m = 1; m <= n_; ++m) {
    const Vector3d origin = disc[m - 1].topRightCorner<3, 1>();
    const double u = beta[m - 1] / 2;
    Vector3d moment = (tip - origin).cross(load_.force);
    for (const Body& body : Bodies(robot_, beta)) {
      if (body.joint >= m) moment += (body.place - origin).cross(body.mass * load_.gravity);
    }
    double expected = moment.dot(disc[m - 1].block<3, 1>(0, 2)) - robot_.Stiffness() * 2 * u;
    for (int j = 0; j < robot_.Cables(); ++j) {
      if (m > robot_.Anchor(j)) continue;
      const double y = robot_.r[j] * (m % 2 ? std::cos(robot_.phi[j]) : std::sin(robot_.phi[j]));
      expected += load_.tension[j] * (y * std::cos(u) - robot_.h[0] / 2 * std::sin(u));
    }
    EXPECT_NEAR(f[m - 1], expected, 1e-15) << "joint " << m;
  }
}

TEST(TwinPivotBalance, PrintedMethodStiffensByTheTensionOverAQuarterDiscAndATwelfthRod) {
  Robot robot = Weightless(Prototype("b"));
  robot.friction = {};
  const Load load = Pull({5, 5, 5, 5});
  const VectorXd beta = VectorXd::Constant(12, 1e-4);
  const VectorXd more = *Residual(robot, load, Method::kVirtualWork, beta) -
                        *Residual(robot, load, Method::kPrinted, beta);
  const double stiffness = 20 * (robot.h[0] / 4 + robot.L[0] / 12);
  // The next terms of the series are smaller by beta^2 = 1e-8.
  EXPECT_NEAR(more[0] / beta[0], stiffness, 1e-7 * stiffness);
}

TEST_P(BalanceOfPrototype, JacobianIsTheSlopeOfTheBalance) {
  // Wide contacts: central differences with 1e-6 rad need a length far above 1e-6 r = 5e-9 m.
  robot_.eps = 1e-4;
  load_.payload = 0.02;
  load_.force = {0.05, -0.1, 0.2};
  load_.moment = {1e-3, -2e-3, 3e-3};
  const VectorXd beta = Random(n_, 0.2, 7);
  for (const Method method : {Method::kVirtualWork, Method::kPrinted}) {
    const MatrixXd slope = *ResidualSlope(robot_, load_, method, beta);
    const double h = 1e-6;
    for (int m = 0; m < n_; ++m) {
      VectorXd above = beta, below = beta;
      above[m] += h;
      below[m] -= h;
      const VectorXd difference =
          (*Residual(robot_, load_, method, above) - *Residual(robot_, load_, method, below)) /
          (2 * h);
      // (h y/eps)^2/6 = 4e-10 of the friction's slope, some 10 N m/rad.
      EXPECT_LT((slope.col(m) - difference).norm(), 1e-8) << "column " << m + 1;
    }
  }
}

}  // namespace
}  // namespace continuum::twin_pivot
