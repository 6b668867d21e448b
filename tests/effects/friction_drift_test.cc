#include "effects/friction_drift.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

double Level(double time, double work, const Vec<double, 4>& law) {
  return FrictionDrift::Level<double>({0, 0.3, 0, 0, 0, time, work}, law);
}

TEST(FrictionDrift, FadesWithTimeOrWork) {
  const Vec<double, 4> by_time{0.05, 0.03, 0.1, 0}, by_work{0.05, 0.03, 0, 2};
  EXPECT_DOUBLE_EQ(Level(0, 0, by_time), 0.08);
  EXPECT_DOUBLE_EQ(Level(10, 5, by_time), 0.05 + 0.03 * std::exp(-1));
  EXPECT_DOUBLE_EQ(Level(10, 0.5, by_work), 0.05 + 0.03 * std::exp(-1));
  EXPECT_NEAR(Level(1000, 0, by_time), 0.05, 1e-12);
}

TEST(FrictionDrift, WithoutRatesIsCoulombs) {
  for (const double t : {0.0, 10.0, 1e4}) EXPECT_EQ(Level(t, t, {0.05, 0.03, 0, 0}), 0.05 + 0.03);
}

TEST(FrictionDrift, GrowsWhereItBeginsLower) {
  const Vec<double, 4> law{0.05, -0.03, 0.1, 0};
  EXPECT_DOUBLE_EQ(Level(0, 0, law), 0.02);
  EXPECT_LT(Level(3, 0, law), Level(4, 0, law));
}

TEST(FrictionDrift, IsNoneWhereItWouldBeNegative) {
  EXPECT_EQ(Level(0, 0, {0.02, -0.05, 0.1, 0}), 0);
}

}  // namespace
}  // namespace continuum
