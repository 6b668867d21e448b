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

// As quick as a number can say, over one step and over a step that its period resolves.
TEST(Pt2, FollowsItsInputAtAnyFrequency) {
  for (const double w : {1e150, 1e160, 1e200, 1e250, 1e300, 1e307}) {
    for (const double zeta : {0.1, 1.0, 1.0 + 1e-9, 10.0}) {
      const auto at = Pt2::Step<double>({0.3, 2.0}, 1, 1e-3, {w, zeta});
      EXPECT_NEAR(at[0], 1, 1e-15) << w << " " << zeta;
      EXPECT_EQ(at[1], 0) << w << " " << zeta;
      const auto scaled = Pt2::Step<double>({0.3, 2.0 * w}, 1, 0.7 / w, {w, zeta});
      const auto one = Pt2::Step<double>({0.3, 2.0}, 1, 0.7, {1, zeta});
      EXPECT_NEAR(scaled[0], one[0], 1e-12) << w << " " << zeta;
      EXPECT_NEAR(scaled[1] / w, one[1], 1e-12) << w << " " << zeta;
    }
  }
}

TEST(Pt2, SettlesFromFarWithoutOverflow) {
  EXPECT_EQ(AfterStep(1e6, 0.5)[0], 1);
  EXPECT_NEAR(AfterStep(1e6, 1e3)[0], 1, 1e-12);
}

}  // namespace
}  // namespace continuum
