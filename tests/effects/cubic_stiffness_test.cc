#include "effects/cubic_stiffness.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

TEST(CubicStiffness, ForceIsTheSlopeOfItsEnergy) {
  const Vec<double, 1> p{3.7};
  const auto energy = [&](double x) { return CubicStiffness::Eval<double>({x, 0}, {}, p).stored; };
  const double h = 1e-4;
  for (const double x : {-0.8, -0.1, 0.3, 1.2}) {
    // Central difference of x⁴/4: error h² x k3.
    EXPECT_NEAR(CubicStiffness::Eval<double>({x, 0}, {}, p).force,
                (energy(x + h) - energy(x - h)) / (2 * h), 2 * h * h * 3.7 * std::abs(x));
  }
}

// I ẍ = −k3 x³ from rest at X swings with the period 4 K(½)/(X sqrt(k3/I)) · … = 7.416298709/
// (X sqrt(k3/I)) (complete elliptic integral; duffing1918).
TEST(CubicStiffness, SwingsWithTheEllipticPeriod) {
  const double k3 = 2.5, X = 0.7, h = 1e-4;
  const Vec<double, 1> p{k3};
  double x = X, v = 0, t = 0;
  while (v <= 0) {  // half a period, by semi-implicit steps
    v -= h * CubicStiffness::Eval<double>({x, v}, {}, p).force;
    x += h * v;
    t += h;
  }
  EXPECT_NEAR(2 * t, 7.416298709 / (X * std::sqrt(k3)), 4 * h);
}

}  // namespace
}  // namespace continuum
