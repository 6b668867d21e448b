#include "effects/directional_friction.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

const Vec<double, 4> kLaw{0.05, 0.02, 0.3, 0.1};

double Level(double v, const Vec<double, 4>& law) {
  return DirectionalFriction::Level<double>({0, v, 0}, law);
}

TEST(DirectionalFriction, SlidesAtTheLevelOfItsDirection) {
  const double bias = DirectionalFriction::Bias<double>(kLaw);
  EXPECT_DOUBLE_EQ(bias - Level(0.4, kLaw), -(0.05 + 0.3 * 0.4));
  EXPECT_DOUBLE_EQ(bias + Level(-0.4, kLaw), 0.02 + 0.1 * 0.4);
}

TEST(DirectionalFriction, HoldsUpToTheLevelOfEitherSide) {
  const double bias = DirectionalFriction::Bias<double>(kLaw);
  EXPECT_DOUBLE_EQ(bias - Level(0, kLaw), -0.05);
  EXPECT_DOUBLE_EQ(bias + Level(0, kLaw), 0.02);
}

TEST(DirectionalFriction, WithEqualSidesIsCoulombAndViscous) {
  const Vec<double, 4> equal{0.05, 0.05, 0.1, 0.1};
  EXPECT_EQ(DirectionalFriction::Bias<double>(equal), 0);
  for (const double v : {-2.0, 0.0, 2.0}) {
    EXPECT_DOUBLE_EQ(Level(v, equal), 0.05 + 0.1 * std::abs(v));
  }
}

}  // namespace
}  // namespace continuum
