#include "effects/lugre.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

constexpr double kInertia = 0.02;
// σ_0, σ_1, τ_c, S, v_s: bristles that bend 0.2 mrad, damped at 0.7 of critical.
const Vec<double, 5> kLaw{200, 2 * 0.7 * 2, 0.04, 0.75, 0.3};

struct Wheel {
  double q = 0, v = 0, t = 0;
  Vec<double, 1> z{0};
  double friction() const { return Lugre::Eval<double>({q, v}, z, kLaw).force; }
  // As the engine: the force from the states at the beginning, then theirs from the new speed.
  void Step(double torque, double h) {
    v += h / kInertia * (torque - friction());
    q += h * v;
    z = Lugre::Step<double>(z, {q, v}, h, kLaw);
    t += h;
  }
};

TEST(Lugre, SlidesSteadilyAtTheStribeckLevel) {
  for (const double v : {0.01, 0.1, 0.5, 5.0}) {
    const auto z = Lugre::Step<double>({0.0}, {0, v}, 10, kLaw);
    const double level = 0.04 * (1 + 0.75 * std::exp(-v * v / 0.09));
    EXPECT_NEAR(Lugre::Eval<double>({0, v}, z, kLaw).force, level, 1e-12);
  }
}

TEST(Lugre, BreaksAwayAtTheStaticLevel) {
  Wheel wheel;
  const double rate = 0.002, start = 0.9 * 0.07;
  double torque = 0;
  while (wheel.t < 20 && (wheel.t < 2 || std::abs(wheel.v) < 1e-3)) {  // the ramp shakes it
    torque = wheel.t < 1 ? start * wheel.t : start + rate * (wheel.t - 1);
    wheel.Step(torque, 5e-4);
  }
  // Beyond the level the wheel needs sqrt(2 I v/rate) = 0.14 s to 1 mrad/s: 3e-4 N m.
  EXPECT_NEAR(torque, 0.07, 0.01 * 0.07);
}

TEST(Lugre, HoldsBelowBreakawayWithoutDrift) {
  for (const double share : {-0.9, 0.5, 0.9}) {
    Wheel wheel;
    for (int k = 0; k < 4000; ++k) wheel.Step(share * 0.07 * std::min(1.0, wheel.t), 5e-4);
    const double held = wheel.q;
    for (int k = 0; k < 40000; ++k) wheel.Step(share * 0.07, 5e-4);
    EXPECT_NEAR(wheel.q, held, 1e-9);
    EXPECT_NEAR(wheel.friction(), share * 0.07, 1e-9);
  }
}

TEST(Lugre, ConvergesInSlidingAsTheStepShrinks) {
  const auto run = [](double h) {
    Wheel wheel;
    const int steps = static_cast<int>(std::lround(1.6 / h));
    for (int k = 0; k < steps; ++k) {
      wheel.Step(0.12 * std::sin(8 * (k + 0.5) * h), h);
    }
    return wheel.q;
  };
  const double fine = run(1e-5);
  double before = std::abs(run(1e-3) - fine);
  for (const double h : {5e-4, 2.5e-4, 1.25e-4}) {
    const double error = std::abs(run(h) - fine);
    EXPECT_LT(error, 0.65 * before);  // first order: a half
    before = error;
  }
  EXPECT_LT(before, 2e-3 * 0.1);
}

// With S = 0 and σ_1 = 0 a stroke rises as 1 − 2 exp(−σ_0 x/τ_c): the loss of a cycle ±X is
// 2 τ_c (2X − 2 τ_c/σ_0).
TEST(Lugre, LosesTheEnergyOfTheClosedFormPerCycle) {
  const double X = 0.01, v = 0.02, h = 1e-4;
  const Vec<double, 5> p{200, 0, 0.04, 0, 0.3};
  Vec<double, 1> z{0};
  double loss = 0;
  const int stroke = 10000;
  for (int k = 0; k < 5 * stroke; ++k) {
    const double speed = (k / stroke) % 2 == 0 ? v : -v;
    const auto next = Lugre::Step<double>(z, {0, speed}, h, p);
    if (k >= 3 * stroke) loss += 0.5 * 0.04 * (z[0] + next[0]) * speed * h;
    z = next;
  }
  const double exact = 2 * 0.04 * (2 * X - 2 * 0.04 / 200);
  EXPECT_NEAR(loss, exact, 1e-5 * exact);  // trapezoids: (σ_0 v h/τ_c)²/12 of the bend
}

}  // namespace
}  // namespace continuum
