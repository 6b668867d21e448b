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

// Five of hard_loads.py twin_pivot. By the paper's rule contacts look at their whole way, and no
// shape that the rising load reaches stands: those at rest flutter away (README).
TEST(TwinPivotStability, ContactsThatTurnBackAsTheArmFallsOverRememberTheWay) {
  const Robot robot = Prototype("b");
  struct Row {
    double pull, tilt, azimuth;  // [N], [deg]
  };
  for (const Row& row : {Row{2, 0.5, 45}, {4, 10, 0}, {6, 0.5, 45}, {8, 0.5, 45}, {8, 20, 135}}) {
    const auto at = [&](double share) {
      const double upper = share * row.pull, lower = share * (row.pull - 1);
      Load load = Upright({upper, upper, lower, lower}, Condition::kV,
                          row.tilt * std::numbers::pi / 180, row.azimuth * std::numbers::pi / 180);
      load.payload = 0.2;
      load.gravity *= share;
      return load;
    };
    const Solution once = Solve(robot, at(1));
    ASSERT_TRUE(once.outcome.ok()) << row.pull << ": " << once.outcome.why;
    EXPECT_EQ(once.stability.branch, Branch::kRising);
    EXPECT_TRUE(once.stability.stable());
    EXPECT_GT(once.parts, 1);
    constexpr int kRows = 100;
    Solution state = Solve(robot, at(1.0 / kRows));
    for (int i = 2; i <= kRows; ++i) {
      state = SolveFrom(robot, at((i - 1.0) / kRows), state, at(1.0 * i / kRows));
      ASSERT_TRUE(state.outcome.ok()) << row.pull << ", " << i << ": " << state.outcome.why;
    }
    // 50 parts: half as fine while it falls over, by 130 mm.
    EXPECT_LT((state.tip - once.tip).norm(), 0.3e-3) << row.pull;
    // Its equations hold from the state that the last part began with, and nothing moves from here.
    Load last = at(1);
    last.reference = once.reference;
    last.slide = once.reference_slide;
    EXPECT_LT(Residual(robot, last, Method::kVirtualWork, once.beta)->norm(), 1e-10);
    EXPECT_LT((SolveFrom(robot, at(1), once, at(1)).tip - once.tip).norm(), 1e-9);
  }
}

// Hanging, the arm never comes near buckling: its way grows evenly, and few parts do.
TEST(TwinPivotStability, WhereTheWayGrowsEvenlyFewPartsEndWhereManyRowsDo) {
  const Robot robot = Prototype("c360");
  const auto at = [](double share) {
    Load load;
    load.tension = {9, 9, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3};
    for (double& tension : load.tension) tension *= share;
    load.gravity = {9.81 * share, 0, 0};
    return load;
  };
  const Solution once = Solve(robot, at(1));
  ASSERT_TRUE(once.outcome.ok()) << once.outcome.why;
  EXPECT_EQ(once.parts, 8);
  constexpr int kRows = 100;
  Solution state = Solve(robot, at(1.0 / kRows));
  for (int i = 2; i <= kRows; ++i) {
    state = SolveFrom(robot, at((i - 1.0) / kRows), state, at(1.0 * i / kRows));
    ASSERT_TRUE(state.outcome.ok()) << i << ": " << state.outcome.why;
  }
  EXPECT_LT((state.tip - once.tip).norm(), 2e-4 * robot.Length());
}

// Contacts at 98 % of their friction still give way elastically. The work of small motions, by
// differences of the moments in the joints, says whether they hold.
TEST(TwinPivotStability, ContactsThatAlmostSlideHoldWhereEverySmallMotionCostsWork) {
  const Robot robot = Prototype("b");
  Load load = Upright({10, 10, 9, 9}, Condition::kV, std::numbers::pi / 18);
  load.payload = 0.2;
  // Where contacts look at their whole way from straight, some end there.
  const Solution solution =
      SolveNear(robot, load, Method::kVirtualWork, Solve(robot, load).beta, 1e-3);
  ASSERT_TRUE(solution.outcome.ok()) << solution.outcome.why;
  EXPECT_TRUE(solution.stability.stable());
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
