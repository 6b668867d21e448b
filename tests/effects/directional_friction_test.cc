#include "effects/directional_friction.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

const Vec<double, 4> kLaw{0.05, 0.02, 0.3, 0.1};

double Level(double v, double lean) {
  return DirectionalFriction::Level<double>({0, v, 0, lean}, kLaw);
}

TEST(DirectionalFriction, SlidesAtTheLevelOfItsDirection) {
  EXPECT_DOUBLE_EQ(Level(0.4, 1e-3), 0.05 + 0.3 * 0.4);
  EXPECT_DOUBLE_EQ(Level(-0.4, -1e-3), 0.02 + 0.1 * 0.4);
  EXPECT_DOUBLE_EQ(Level(0.4, 0), Level(0.4, 1e-3));
}

TEST(DirectionalFriction, HoldsAtRestByTheSideItLeansTo) {
  EXPECT_EQ(Level(0, 1e-9), 0.05);
  EXPECT_EQ(Level(0, -1e-9), 0.02);
  EXPECT_EQ(Level(-1e-15, 1e-9), 0.05);
  EXPECT_EQ(Level(0, 0), 0.05);  // not known yet: the larger
}

TEST(DirectionalFriction, WithEqualSidesIsCoulombAndViscous) {
  const Vec<double, 4> equal{0.05, 0.05, 0.1, 0.1};
  for (const double v : {-2.0, 0.0, 2.0}) {
    EXPECT_DOUBLE_EQ(DirectionalFriction::Level<double>({0, v, 0, v}, equal),
                     0.05 + 0.1 * std::abs(v));
  }
}

}  // namespace
}  // namespace continuum
