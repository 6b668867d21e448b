#include "effects/bouc_wen.h"

#include <cmath>

#include <gtest/gtest.h>

#include "effects/dahl.h"

namespace continuum {
namespace {

constexpr double kRho = 40;

double After(double w, double path, double sigma, double n, double speed = 0.1) {
  const double v = path < 0 ? -speed : speed;
  return BoucWen::Step<double>({w}, {0, v}, path / v, {1, kRho, sigma, n})[0];
}

TEST(BoucWen, LoadsAlongTheClosedForms) {
  for (const double x : {1e-3, 0.01, 0.05, 0.2}) {
    EXPECT_NEAR(After(0, x, 0.8, 1), 1 - std::exp(-kRho * x), 1e-7);
    EXPECT_NEAR(After(0, -x, 0.8, 2), -std::tanh(kRho * x), 1e-7);
  }
}

// From w = −1 with σ = ½ the law is straight up to w = 0, and exponential after it.
TEST(BoucWen, TurnsExactlyAtTheKink) {
  for (const double x : {0.3, 0.99, 1.0, 1.01, 1.7, 6.0}) {
    const double exact = x < 1 ? x - 1 : 1 - std::exp(-(x - 1));
    EXPECT_NEAR(After(-1, x / kRho, 0.5, 1), exact, 1e-7) << x;
  }
}

TEST(BoucWen, StepsOfAnyLengthAgreeForEveryKnee) {
  for (const double n : {1.0, 1.3, 2.0, 7.5}) {
    for (const double sigma : {0.5, 1.0, 3.0}) {
      const double whole = After(-0.9, 2.5 / kRho, sigma, n);
      double w = -0.9;
      for (int k = 0; k < 1000; ++k) w = After(w, 2.5e-3 / kRho, sigma, n);
      EXPECT_NEAR(whole, w, 1e-6) << "n " << n << " sigma " << sigma;
      EXPECT_LE(std::abs(whole), 1);
    }
  }
}

TEST(BoucWen, DependsOnThePathNotOnSpeed) {
  EXPECT_NEAR(After(0.3, -0.05, 0.7, 1.5, 0.01), After(0.3, -0.05, 0.7, 1.5, 10), 1e-12);
}

TEST(BoucWen, IsDahlForTheKneeOne) {
  for (const double w : {-0.7, 0.0, 0.4}) {
    const double f = 0.3;
    const auto z = Dahl::Step<double>({w}, {0, 0.1}, 0.2, {f * kRho, f});
    EXPECT_NEAR(After(w, 0.02, 1, 1), z[0], 1e-7);
  }
}

// A wide cycle ±X with σ = ½, n = 1 rises along the curve of TurnsExactlyAtTheKink: the loss is
// 2 κ_w (2X − 5/(2ρ)).
TEST(BoucWen, LosesTheEnergyOfTheClosedFormPerCycle) {
  const double X = 1, kappa = 0.3, h = 1e-3, v = 0.2;
  const Vec<double, 4> p{kappa, kRho, 0.5, 1};
  Vec<double, 1> w{0};
  double loss = 0;
  const int stroke = 10000;  // of h · v each: 2 X
  for (int k = 0; k < 5 * stroke; ++k) {
    const double speed = (k / stroke) % 2 == 0 ? v : -v;
    const auto next = BoucWen::Step<double>(w, {0, speed}, h, p);
    if (k >= 3 * stroke) loss += 0.5 * kappa * (w[0] + next[0]) * speed * h;
    w = next;
  }
  // Trapezoids on a curve with slope ρ: relative error (ρ v h)²/12 of 1/ρ.
  const double exact = 2 * kappa * (2 * X - 2.5 / kRho);
  EXPECT_NEAR(loss, exact, 1e-5 * exact);
}

}  // namespace
}  // namespace continuum
