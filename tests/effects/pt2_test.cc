#include "effects/pt2.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

constexpr double kW = 25;

Vec<double, 2> AfterStep(double t, double zeta) {
  return Pt2::Step<double>({0.0, 0.0}, 1, t, {kW, zeta});
}

TEST(Pt2, OvershootsAsTheTextbook) {
  const double zeta = 0.3, root = std::sqrt(1 - zeta * zeta), peak = M_PI / (kW * root);
  const auto at = AfterStep(peak, zeta);
  EXPECT_NEAR(at[0], 1 + std::exp(-M_PI * zeta / root), 1e-14);
  EXPECT_NEAR(at[1], 0, 1e-12);
}

TEST(Pt2, IsExactForCriticalAndStrongDamping) {
  for (const double t : {1e-3, 0.02, 0.4}) {
    EXPECT_NEAR(AfterStep(t, 1)[0], 1 - (1 + kW * t) * std::exp(-kW * t), 1e-14);
    const double d = kW * std::sqrt(4.0 * 4.0 - 1), a = 4 * kW - d, b = 4 * kW + d;
    EXPECT_NEAR(AfterStep(t, 4)[0], 1 - (b * std::exp(-a * t) - a * std::exp(-b * t)) / (b - a),
                1e-13);
  }
}

TEST(Pt2, IsSmoothAroundCriticalDamping) {
  for (const double eps : {1e-9, 1e-6, 1e-4}) {
    EXPECT_NEAR(AfterStep(0.05, 1 + eps)[0], AfterStep(0.05, 1 - eps)[0], 2 * eps);
  }
}

TEST(Pt2, SettlesFromFarWithoutOverflow) {
  EXPECT_EQ(AfterStep(1e6, 0.5)[0], 1);
  EXPECT_NEAR(AfterStep(1e6, 1e3)[0], 1, 1e-12);
}

}  // namespace
}  // namespace continuum
