#include "models/tdcr/rubbing.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

const Eigen::Vector2d kHole(0.03, -0.04);
const ChannelPoint kParallel{kHole, {0, 0}, {0, 0}};
const Vector3d kCurvature(1.2, -0.7, 0.4), kRate(0.5, 2, -0.3);

// t' by the turn of the tendon's unit vector over a short piece, seen from the frame of its start.
TEST(TdcrRubbing, LosesInProportionToTheTurnOfTheTendon) {
  const auto direction = [](double s) {
    const Vector3d u = kCurvature + s * kRate;
    const Vector3d w(-u.z() * kHole.y(), u.z() * kHole.x(),
                     1 + u.x() * kHole.y() - u.y() * kHole.x());
    const Vector3d half = s / 2 * kCurvature;  // the frame has turned by s u, to first order
    const Vector3d t = w.normalized();
    return Vector3d(t + 2 * half.cross(t));
  };
  const double h = 1e-5;
  const double turn = (direction(h) - direction(-h)).norm() / (2 * h);
  const Rubbing<double> rubbing(kParallel, true, kCurvature, 0.3);
  EXPECT_NEAR(rubbing.Slope(kRate), -0.3 * turn, 1e-8);
  EXPECT_EQ(Rubbing<double>(kParallel, true, kCurvature, -0.3).Slope(kRate), -rubbing.Slope(kRate));
}

TEST(TdcrRubbing, GradientIsTheDerivativeOfTheSlope) {
  using Dual = ceres::Jet<double, 3>;
  Eigen::Matrix<Dual, 3, 1> rate;
  for (int i = 0; i < 3; ++i) rate[i] = Dual(kRate[i], i);
  const Rubbing<Dual> dual(kParallel, true, kCurvature.cast<Dual>(), Dual(0.3));
  const Vector3d gradient = Rubbing<double>(kParallel, true, kCurvature, 0.3).Gradient(kRate);
  EXPECT_LT((dual.Slope(rate).v - gradient).norm(), 1e-14);
}

}  // namespace
}  // namespace continuum::tdcr
