#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "models/twin_pivot/again.h"
#include "models/twin_pivot/bench.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::MatrixXd;
using statics::Branch;

// Stands upright: gravity along -x, tilted by `tilt` toward -y cos - z sin of `azimuth`.
Load Upright(std::vector<double> tension, Condition condition, double tilt = 0,
             double azimuth = 0) {
  Load load = Pull(std::move(tension), condition);
  load.gravity = 9.81 * Vector3d(-std::cos(tilt), -std::sin(tilt) * std::cos(azimuth),
                                 -std::sin(tilt) * std::sin(azimuth));
  return load;
}

// Lowest eigenvalue of the second differences of an energy without recursion, over a joint's
// stiffness.
double LowestStiffness(const Robot& robot, const Load& load, const VectorXd& beta) {
  const auto weights = again::Bodies(robot, beta);
  const double step = 1e-4;  // one-sided: 1e-5 of the third derivatives, 1e-8 of rounding
  const auto n = beta.size();
  const auto energy = [&](const VectorXd& at) { return again::Energy(robot, load, at, weights); };
  const double middle = energy(beta);
  VectorXd one(n);
  for (Eigen::Index i = 0; i < n; ++i) one[i] = energy(beta + step * VectorXd::Unit(n, i));
  MatrixXd hessian(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const VectorXd both = step * (VectorXd::Unit(n, i) + VectorXd::Unit(n, j));
      const double mixed = energy(beta + both) - one[i] - one[j] + middle;
      hessian(i, j) = hessian(j, i) = mixed / (step * step * robot.Stiffness());
    }
  }
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(hessian).eigenvalues()[0];
}

TEST(TwinPivotStability, LoadsNearUprightEndAtMinimaOfAnIndependentEnergy) {
  const Robot robot = Prototype("b");
  for (unsigned seed = 1; seed <= 15; ++seed) {
    const VectorXd r = (Random(8, 0.5, seed).array() + 0.5).matrix();
    const double base = 2 + 8 * r[0];
    std::vector<double> tension;
    for (int j = 0; j < 4; ++j) tension.push_back(base * (0.8 + 0.4 * r[1 + j]));
    Load load =
        Upright(tension, Condition::kI, r[5] * std::numbers::pi / 6, 2 * std::numbers::pi * r[6]);
    load.force = 0.2 * r[7] * load.gravity;  // up to 200 g
    const Solution solution = Solve(robot, load);
    ASSERT_TRUE(solution.outcome.ok()) << seed << ": " << solution.outcome.why;
    EXPECT_EQ(solution.stability.unstable_directions, 0);
    // Cable weights follow their bent lengths in the energy's places alone: 1e-4 of a joint.
    EXPECT_GT(LowestStiffness(robot, load, solution.beta), -1e-4) << seed;
  }
}

TEST(TwinPivotStability, TheUpperPairThatPullsHarderWins) {
  const Robot robot = Prototype("b");
  Load load = Upright({6, 6, 5, 5}, Condition::kI);
  load.force = {-1.1772, 0, 0};
  const Solution light = Solve(robot, load);
  ASSERT_TRUE(light.outcome.ok());
  EXPECT_LT((light.tip - Vector3d(0.0655, 0.1145, 0)).norm(), 1e-3);
  load.force = {-1.4715, 0, 0};
  EXPECT_LT((Solve(robot, load).tip - Vector3d(0.0303, 0.1215, 0)).norm(), 1e-3);
  load = Upright({6, 6, 5, 5}, Condition::kV);
  load.payload = 0.15;
  const Solution rubbing = Solve(robot, load);
  ASSERT_TRUE(rubbing.outcome.ok());
  EXPECT_GT(rubbing.tip.y(), 0.05);
}

TEST(TwinPivotStability, EqualTensionsUprightBendToOneSideAndSaySo) {
  const Robot robot = Prototype("b");
  Load load = Upright({6, 6, 6, 6}, Condition::kI);
  load.force = {-1.5, 0, 0};
  const Solution solution = Solve(robot, load);
  ASSERT_TRUE(solution.outcome.ok()) << solution.outcome.why;
  EXPECT_EQ(solution.stability.branch, Branch::kSymmetric);
  EXPECT_GT(std::hypot(solution.tip.y(), solution.tip.z()), 0.05);
}

// Contacts at 98 % of their friction still give way elastically. The work of small motions, by
// differences of the moments in the joints, says whether they hold.
TEST(TwinPivotStability, ContactsThatAlmostSlideHoldWhereEverySmallMotionCostsWork) {
  const Robot robot = Prototype("b");
  Load load = Upright({10, 10, 9, 9}, Condition::kV, std::numbers::pi / 18);
  load.payload = 0.2;
  const Solution solution = Solve(robot, load);
  ASSERT_TRUE(solution.outcome.ok()) << solution.outcome.why;
  const double largest = solution.slide.cwiseAbs().maxCoeff();
  EXPECT_GT((solution.slide.array().abs() > 0.98 && solution.slide.array().abs() < 0.99).count(), 0)
      << largest;
  const double step = 1e-7;  // 5e-10 m of cable, where contacts turn within 1e-6 m
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const VectorXd way = Random(robot.Joints(), 1, seed).normalized();
    const auto above = Residual(robot, load, Method::kVirtualWork, solution.beta + step * way);
    const auto below = Residual(robot, load, Method::kVirtualWork, solution.beta - step * way);
    ASSERT_TRUE(above && below);
    EXPECT_GT(-way.dot(*above - *below) / (2 * step), 0.1 * robot.Stiffness()) << seed;
  }
}

}  // namespace
}  // namespace continuum::twin_pivot
