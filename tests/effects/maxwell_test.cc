#include "effects/maxwell.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

constexpr double kM = 0.8, kTau = 0.3;

TEST(Maxwell, RelaxesExponentiallyWhenHeld) {
  const Vec<double, 2> p{kM, kTau};
  Vec<double, 1> e{0.1};
  for (int k = 1; k <= 5; ++k) {
    e = Maxwell::Step<double>(e, {0, 0}, 0.1, p);
    EXPECT_NEAR(Maxwell::Eval<double>({0, 0}, e, p).force, kM * 0.1 * std::exp(-0.1 * k / kTau),
                1e-15);
  }
}

TEST(Maxwell, SteadyMotionMeetsADamper) {
  const Vec<double, 2> p{kM, kTau};
  const auto e = Maxwell::Step<double>({0.0}, {0, 0.5}, 100 * kTau, p);
  EXPECT_NEAR(Maxwell::Eval<double>({0, 0.5}, e, p).force, kM * kTau * 0.5, 1e-15);
}

// Under x = X sin ωt the loss per cycle is π X² k_m ωτ/(1 + (ωτ)²).
TEST(Maxwell, LosesTheEnergyOfTheClosedFormPerCycle) {
  const Vec<double, 2> p{kM, kTau};
  const double X = 0.2;
  for (const double w : {0.5, 1 / kTau, 30.0}) {
    const double exact = M_PI * X * X * kM * w * kTau / (1 + w * kTau * w * kTau);
    double before = 1;
    for (const int steps : {500, 1000, 2000}) {
      const double h = 2 * M_PI / w / steps;
      Vec<double, 1> e{0};
      double loss = 0;
      const int settling = steps * (1 + static_cast<int>(40 * kTau / (2 * M_PI / w)));
      for (int k = 0; k < settling + steps; ++k) {
        // The mean speed of the step; force before and after it.
        const double v = X * (std::sin(w * h * (k + 1)) - std::sin(w * h * k)) / h;
        const auto next = Maxwell::Step<double>(e, {0, v}, h, p);
        if (k >= settling) loss += 0.5 * kM * (e[0] + next[0]) * v * h;
        e = next;
      }
      const double error = std::abs(loss / exact - 1);
      EXPECT_LT(error, 0.3 * before);  // second order: a quarter
      before = error;
    }
    EXPECT_LT(before, 1e-4);
  }
}

// A mass m on the element alone, pushed with a constant force: creep with the speed F/c.
TEST(Maxwell, CreepsUnderAConstantLoad) {
  const Vec<double, 2> p{kM, kTau};
  const double h = 1e-3, F = 0.1;
  double x = 0, v = 0;
  Vec<double, 1> e{0};
  double early = 0;
  for (int k = 0; k < 60000; ++k) {
    v += h / 0.01 * (F - Maxwell::Eval<double>({x, v}, e, p).force);
    x += h * v;
    e = Maxwell::Step<double>(e, {x, v}, h, p);
    if (k == 29999) early = x;
  }
  EXPECT_NEAR((x - early) / 30, F / (kM * kTau), 1e-6);
}

}  // namespace
}  // namespace continuum
