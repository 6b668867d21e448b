#include "effects/bouc_wen.h"

#include <cmath>
#include <numbers>

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
  const Vec<double, 5> p{kappa, kRho, 0.5, 1};
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

double Hardening(double w, double path, double n, double eta, double sigma = 0.5) {
  const double v = path < 0 ? -0.1 : 0.1;
  return BoucWen::Step<double>({w}, {0, v}, path / v, {1, kRho, sigma, n, eta})[0];
}

TEST(BoucWen, StiffensAlongTheClosedForms) {
  for (const double x : {1e-3, 0.01, 0.03}) {
    const double path = kRho * x;
    EXPECT_NEAR(Hardening(0, x, 1.7, 1), path, 1e-12);
    EXPECT_NEAR(Hardening(0, x, 1, 1.4), std::expm1(0.4 * path) / 0.4, 1e-7);
    EXPECT_NEAR(Hardening(0, -x, 2, 2), -std::tan(path), 1e-6);
    EXPECT_NEAR(Hardening(0, x, 2, 0.75), 2 * std::tanh(0.5 * path), 1e-7);
  }
  EXPECT_TRUE(std::isinf(Hardening(0, 1.01 * std::numbers::pi / 2 / kRho, 2, 2)));
}

// With σ = ½ and n = 1 unloading is u' = 1 − ηu: from u = 1/η − (1 + 1/η) e^{ηx} to −1 over x.
TEST(BoucWen, UnloadsAlongTheClosedFormWhateverItsHardening) {
  for (const double eta : {0.3, 1.0, 1.2}) {
    const double path = 0.4;
    const double exact = (1 + eta) / eta * -std::exp(eta * path) + 1 / eta;
    EXPECT_NEAR(Hardening(exact, path / kRho, 1, eta), -1, 1e-7) << eta;
  }
}

// Across η = 1, where the plateau goes to infinity, and where the way of computing changes.
TEST(BoucWen, IsContinuousInItsHardening) {
  for (const double n : {1.0, 1.6, 3.0}) {
    for (const double eta : {0.0, 0.95, 1.0}) {
      const double below = Hardening(-0.5, 0.05, n, std::max(0.0, eta - 1e-7));
      EXPECT_NEAR(below, Hardening(-0.5, 0.05, n, eta + 1e-7), 1e-5) << n << " " << eta;
    }
  }
}

// The same loop in other units of its state.
TEST(BoucWen, SigmaAndEtaSayTheSameInAnotherUnitOfTheState) {
  const double n = 1.5, sigma = 1.3, eta = 0.4, z = 1.7;
  const double scaled = std::pow(z, n);
  for (const double path : {0.01, -0.08, 0.3}) {
    const double v = path < 0 ? -0.1 : 0.1;
    const auto step = [&](double w, const Vec<double, 5>& p) {
      return BoucWen::Step<double>({w}, {0, v}, path / v, p)[0];
    };
    EXPECT_NEAR(z * step(0.2 / z, {1, kRho / z, sigma * scaled, n, 1 - (1 - eta) * scaled}),
                step(0.2, {1, kRho, sigma, n, eta}), 1e-6);
  }
}

// ψ is the work of the closed curve that its slope g gives: ∫ w/(1 + cw) dw for n = 1.
TEST(BoucWen, StoresWhatItsDocumentationSays) {
  const double eta = 1.6, c = 0.6 + 0.6 / 1.6;
  for (const double w : {0.1, 1.0, -30.0}) {
    const double a = std::abs(w), exact = 0.3 / kRho * (a / c - std::log1p(c * a) / (c * c));
    EXPECT_NEAR(BoucWen::Eval<double>({0, 0.1}, {w}, {0.3, kRho, 0.5, 1, eta}).stored, exact,
                1e-9 * exact);
  }
}

}  // namespace
}  // namespace continuum
