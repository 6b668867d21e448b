#include "effects/sensor_eccentricity.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

double Reading(double angle, const Vec<double, 3>& law) {
  return SensorEccentricity::Eval<double>([=](double) { return angle; }, 0.3, law);
}

TEST(SensorEccentricity, ErrsByTheSameAfterATurn) {
  const Vec<double, 3> law{0.02, -0.01, 1};
  for (const double q : {-1.0, 0.2, 2.0}) {
    EXPECT_NEAR(Reading(q, law) - q, Reading(q + 2 * M_PI, law) - (q + 2 * M_PI), 1e-14);
    EXPECT_NEAR(Reading(q, law) - q, 0.02 * std::cos(q) - 0.01 * std::sin(q), 1e-15);
  }
}

// A disc whose centre is e off the axis, read at the radius R, errs by e/R.
TEST(SensorEccentricity, IsThatOfADiscOffItsAxis) {
  constexpr double e = 1e-4, R = 1;
  for (const double q : {0.3, 1.7, 4.0}) {
    const double seen = q + std::atan2(e * std::sin(q), R + e * std::cos(q));
    EXPECT_NEAR(Reading(q, {0, e / R, 1}), seen, 2 * e * e);
  }
}

// A resolver whose sine is larger than its cosine by a share s errs by s/2 sin 2q.
TEST(SensorEccentricity, IsThatOfAResolverWithUnequalTracks) {
  constexpr double s = 1e-4;
  for (const double q : {-0.9, 0.3, 1.4}) {
    const double seen = std::atan2((1 + s) * std::sin(q), std::cos(q));
    EXPECT_NEAR(Reading(q, {0, s / 2, 2}), seen, s * s);
  }
}

}  // namespace
}  // namespace continuum
