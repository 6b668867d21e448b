#include <gtest/gtest.h>

#include <cmath>

#include "models/twin_pivot/again.h"
#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/joint.h"

namespace continuum::twin_pivot {
namespace {

using again::CableLength;
using again::Discs;
using Eigen::MatrixXd;

class GeometryOfPrototype : public EveryPrototype {};
INSTANTIATE_TEST_SUITE_P(TwinPivot, GeometryOfPrototype, testing::Values("a", "b", "c"));

TEST(TwinPivotGeometry, StumpffFunctionsAreTheClosedForms) {
  for (const double b : {0.3, -1.0, 2.0, 3.1}) {
    const auto c = Stumpff(b);
    // The closed forms divide rounding of 1e-16 by b^5 at worst.
    const double rounding = 1e-15 / std::pow(std::abs(b), 5) + 1e-15;
    EXPECT_NEAR(c[0], std::cos(b), rounding);
    EXPECT_NEAR(c[1], std::sin(b) / b, rounding);
    EXPECT_NEAR(c[2], (1 - std::cos(b)) / (b * b), rounding);
    EXPECT_NEAR(c[3], (b - std::sin(b)) / std::pow(b, 3), rounding);
    EXPECT_NEAR(c[4], (std::cos(b) - 1 + b * b / 2) / std::pow(b, 4), rounding);
    EXPECT_NEAR(c[5], (std::sin(b) - b + std::pow(b, 3) / 6) / std::pow(b, 5), rounding);
  }
}

TEST(TwinPivotGeometry, NothingHappensAtZeroBend) {
  const Robot robot = Prototype("a");
  const Joint<double> straight(robot.Links().front(), 0.0);
  EXPECT_DOUBLE_EQ(straight.origin.x, robot.L[0] + robot.h[0]);
  EXPECT_DOUBLE_EQ(straight.centre.x, (robot.h[0] + robot.L[0]) / 2);
  EXPECT_DOUBLE_EQ(straight.Length(0.003), robot.L[0]);
  for (const double b : {1e-12, 1e-6, 1e-3}) {
    const Joint<double> bent(robot.Links().front(), b);
    // First terms of the series in b; what follows is smaller by b^2, or rounding.
    const double next = robot.L[0] * b * (b * b + 1e-15);
    EXPECT_NEAR(bent.bend, robot.L[0] * b / 12, next);
    EXPECT_NEAR(bent.centre.y, robot.L[0] * b / 6, next);
    EXPECT_NEAR(bent.Length(0.003), robot.L[0] - 0.003 * b, robot.L[0] * b * b);
  }
}

TEST_P(GeometryOfPrototype, CentreLineEndsWhereThePapersTransformsEnd) {
  const VectorXd beta = Random(n_, 0.3, 1);
  const Vector3d tip = Discs(robot_, beta).back().topRightCorner<3, 1>();
  EXPECT_LT((CentreLine(robot_, beta).back() - tip).norm(), 1e-15);
}

TEST_P(GeometryOfPrototype, CablesAreStraightLinesBetweenTheirHoles) {
  const VectorXd beta = Random(n_, 0.3, 2);
  const auto disc = Discs(robot_, beta);
  const MatrixXd length = CableLengths(robot_, beta);
  for (int j = 0; j < robot_.Cables(); ++j) {
    for (int m = 1; m <= n_; ++m) {
      const double expected = m <= robot_.Anchor(j) ? CableLength(robot_, disc, m, j) : 0;
      EXPECT_NEAR(length(m - 1, j), expected, 1e-16) << "joint " << m << " cable " << j + 1;
    }
  }
}

TEST(TwinPivotGeometry, OddJointsLiftAndEvenOnesTurnTowardZ) {
  const Robot robot = Prototype("a");
  VectorXd beta = VectorXd::Zero(6);
  beta[0] = 0.1;
  EXPECT_GT(CentreLine(robot, beta).back().y(), 1e-3);
  beta << 0, 0.1, 0, 0, 0, 0;
  EXPECT_GT(CentreLine(robot, beta).back().z(), 1e-3);
}

}  // namespace
}  // namespace continuum::twin_pivot
