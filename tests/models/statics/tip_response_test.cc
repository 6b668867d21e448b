#include "models/statics/tip_response.h"

#include <gtest/gtest.h>

namespace continuum::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Two springs k_0, k_1 in a row at the joints of an arm of one link on a slide, without bending:
/// unknown the way z_0 along x and the angle z_1 about z; inputs a force along x, a moment about z
/// and the tension of a cable along -x. The tip is at (z_0 + cos z_1, sin z_1, 0).
class Arm : public Responding {
 public:
  bool Residual(const VectorXd& z, const VectorXd& w, VectorXd& f) const override {
    f.resize(2);
    f << 3 * z[0] - w[0] + w[2], 5 * z[1] - w[1];
    return true;
  }
  bool Tangent(const VectorXd& /*z*/, MatrixXd& k) const override {
    k << 3, 0, 0, 5;
    return true;
  }
  std::optional<Shown> Show(const VectorXd& z, const VectorXd& /*w*/) const override {
    const Eigen::Quaterniond frame(Eigen::AngleAxisd(z[1], Eigen::Vector3d::UnitZ()));
    return Shown{
        {z[0] + std::cos(z[1]), std::sin(z[1]), 0}, frame, VectorXd::Constant(1, z[0]), {}};
  }
};

TEST(TipResponse, IsThatOfSpringsInSeries) {
  const double angle = 0.4;
  const auto slope = Respond(Arm(), Eigen::Vector2d(0, angle), 3);
  ASSERT_TRUE(slope);
  MatrixXd exact = MatrixXd::Zero(7, 3);
  exact.row(0) << 1.0 / 3, -std::sin(angle) / 5, -1.0 / 3;
  exact(1, 1) = std::cos(angle) / 5;
  exact(5, 1) = 1.0 / 5;
  exact.row(6) << 1.0 / 3, 0, -1.0 / 3;
  EXPECT_LT((*slope - exact).cwiseAbs().maxCoeff(), 1e-9);  // differences of steps of 1e-5
}

// At no tension there is only one side to differentiate from.
TEST(TipResponse, OfASlackCableIsThatOfThePull) {
  class NeverPushes : public Arm {
    bool Residual(const VectorXd& z, const VectorXd& w, VectorXd& f) const override {
      return Arm::Residual(z, w, f) && w[2] >= 0;
    }
  };
  const Eigen::Vector2d z(0, 0.4);
  const auto pulled = Respond(NeverPushes(), z, 3), any = Respond(Arm(), z, 3);
  ASSERT_TRUE(pulled && any);
  EXPECT_LT((*pulled - *any).cwiseAbs().maxCoeff(), 1e-9);
}

// A held cable keeps the slide: the force tensions the cable, the length moves the tip.
TEST(TipResponse, AHeldCableHoldsTheTip) {
  TipResponse by_tension{{"fx", "Mz", "T1"}, 2, *Respond(Arm(), Eigen::Vector2d(0, 0), 3)};
  const auto held = HoldLengths(by_tension, VectorXd::Constant(1, 1));
  ASSERT_TRUE(held);
  EXPECT_EQ(held->input.back(), "L1");
  EXPECT_NEAR(held->slope(0, 0), 0, 1e-9);
  EXPECT_NEAR(held->slope(0, 2), 1, 1e-9);
  EXPECT_NEAR(held->slope(6, 0), 1, 1e-9);
  EXPECT_NEAR(held->slope(6, 2), -3, 1e-8);
  const auto slack = HoldLengths(by_tension, VectorXd::Zero(1));
  ASSERT_TRUE(slack);
  EXPECT_NEAR(slack->slope(0, 0), 1.0 / 3, 1e-9);
  EXPECT_EQ(slack->slope.col(2).norm(), 0);
}

TEST(TipResponse, TheEllipsoidHasTheSingularValues) {
  TipResponse response{{"fx", "fy", "fz"}, 3, MatrixXd::Zero(6, 3)};
  response.slope.topRows(3).diagonal() << 2, 7, 1;
  const Eigen::Matrix3d axes = Ellipsoid(response, false);
  EXPECT_NEAR(axes.col(0).norm(), 7, 1e-12);
  EXPECT_NEAR(std::abs(axes(1, 0)), 7, 1e-12);
  EXPECT_NEAR(std::abs(axes(0, 1)), 2, 1e-12);
  EXPECT_NEAR(std::abs(axes(2, 2)), 1, 1e-12);
}

}  // namespace
}  // namespace continuum::statics
