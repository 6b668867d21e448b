#include <gtest/gtest.h>

#include <cmath>

#include "error.h"
#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::MatrixXd;

class FrictionOfPrototype : public EveryPrototype {};
INSTANTIATE_TEST_SUITE_P(TwinPivot, FrictionOfPrototype, testing::Values("a", "b", "c"));

TEST_P(FrictionOfPrototype, FrictionOpposesTheSlideAtEveryContact) {
  const MatrixXd straight = CableLengths(robot_, VectorXd::Zero(n_));
  for (unsigned seed = 10; seed < 20; ++seed) {
    const Load load = Pull(RandomTension(robot_.Cables(), seed));
    const Solution solution = Solve(robot_, load);
    ASSERT_TRUE(solution.outcome.ok());
    for (int j = 0; j < robot_.Cables(); ++j) {
      double before = load.tension[j];
      for (int m = 0; m < robot_.Anchor(j); ++m) {
        const int rest = robot_.Anchor(j) - m;
        const double change = (solution.length.col(j) - straight.col(j)).segment(m, rest).sum();
        // Rounding of the two factors, each some 1e-15 N and 1e-17 m.
        EXPECT_GE((solution.tension(m, j) - before) * change, -1e-18);
        before = solution.tension(m, j);
      }
    }
  }
}

TEST_P(FrictionOfPrototype, TensionChangesByTheFrictionOfBothSidesOfADisc) {
  const Solution solution = Solve(robot_, load_);
  const MatrixXd straight = CableLengths(robot_, VectorXd::Zero(n_));
  const auto rub = [&](int m, int j) {
    const double theta = std::abs(solution.beta[m]) / 2;
    return robot_.friction.At(theta) * std::sin(theta) * solution.tension(m, j);
  };
  for (int j = 0; j < robot_.Cables(); ++j) {
    for (int m = 0; m < robot_.Anchor(j); ++m) {
      const int rest = robot_.Anchor(j) - m;
      const double change = (solution.length.col(j) - straight.col(j)).segment(m, rest).sum();
      const double before = m == 0 ? load_.tension[j] : solution.tension(m - 1, j);
      const double friction = rub(m, j) + (m == 0 ? 0 : rub(m - 1, j));
      EXPECT_NEAR(solution.tension(m, j) - before, std::tanh(change / robot_.eps) * friction,
                  1e-10);
    }
  }
}

TEST_P(FrictionOfPrototype, StateThatNamesItselfAsReferenceHasNoFriction) {
  const Solution free = Solve(robot_, Pull(load_.tension, Condition::kI));
  load_.condition = Condition::kII;
  load_.reference = free.length;
  EXPECT_LT((Solve(robot_, load_).beta - free.beta).norm(), 1e-9);
}

TEST(TwinPivotFriction, ReleasedRobotStaysMoreBentThanPulledOne) {
  const Robot robot = Prototype("b");
  const Solution far = Solve(robot, Pull({18, 18, 8, 8}));
  Load back = Pull({14, 14, 8, 8});
  const Solution pulled = Solve(robot, back);
  back.reference = far.length;
  const Solution released = Solve(robot, back);
  ASSERT_TRUE(released.outcome.ok());
  EXPECT_GT(released.tip.y(), pulled.tip.y() + 1e-3);
  EXPECT_LT(released.tip.y(), far.tip.y());
}

TEST_P(FrictionOfPrototype, SharpContactsAreTheLimitOfWideOnes) {
  std::vector<Vector3d> tip;
  for (const double eps : {1e-4, 1e-5, 1e-6, 1e-7}) {
    robot_.eps = eps;
    const Solution solution = Solve(robot_, load_);
    ASSERT_TRUE(solution.outcome.ok()) << solution.outcome.why;
    tip.push_back(solution.tip);
  }
  // What is left goes with eps itself; a lever of n joints makes it some times larger.
  EXPECT_LE((tip[2] - tip[3]).norm(), 1e-4);
  EXPECT_LE((tip[2] - tip[3]).norm(), (tip[0] - tip[1]).norm() + 1e-12);
}

TEST_P(FrictionOfPrototype, SolutionDoesNotDependOnTheStart) {
  for (unsigned seed = 100; seed < 400; ++seed) {
    const Load load = Pull(RandomTension(robot_.Cables(), seed));
    const Solution straight = Solve(robot_, load);
    const Solution other = Solve(robot_, load, Method::kVirtualWork, Random(n_, 0.5, seed));
    ASSERT_TRUE(straight.outcome.ok() && other.outcome.ok());
    EXPECT_LE(straight.outcome.residual, 1e-10);
    EXPECT_LT((straight.beta - other.beta).norm(), 1e-9);
  }
}

TEST(TwinPivotFriction, NegativeCoefficientInUseIsBadInput) {
  Robot robot = Prototype("a");
  robot.friction = {0, -5, 0.1};
  EXPECT_THROW(Solve(robot, Pull({10, 10, 1, 1})), Error);
  EXPECT_NO_THROW(Solve(robot, Pull({10, 10, 1, 1}, Condition::kI)));
}

TEST(TwinPivotFriction, ContactThatWouldLockIsOutOfTheDomain) {
  Robot robot = Prototype("a");
  robot.friction = {0, 0, 20};
  const VectorXd beta = VectorXd::Constant(6, 0.2);
  EXPECT_FALSE(Residual(robot, Pull({9, 9, 1, 1}), Method::kVirtualWork, beta));
}

TEST(TwinPivotFriction, HopelessCaseSaysSo) {
  const Solution solution = Solve(Prototype("a"), Pull({1e9, 0, 0, 0}));
  EXPECT_FALSE(solution.outcome.ok());
  EXPECT_FALSE(solution.outcome.why.empty());
}

}  // namespace
}  // namespace continuum::twin_pivot
