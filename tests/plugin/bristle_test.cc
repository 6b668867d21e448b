#include "binding/bristle.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

constexpr double kGive = 1e-4;

// Calls see(ζ, v) all over both sides of the corners.
template <class See>
void ForEachState(See&& see) {
  for (double deflection = -1; deflection <= 1; deflection += 0.125) {
    for (double v = -0.04; v <= 0.04; v += 1e-3) see(deflection, v);
  }
}

// Per unit of the level, power in is u v, and the spring ½ g ζ² takes g ζ ζ' of it.
TEST(BristleLaw, NeverCreatesEnergy) {
  ForEachState([](double deflection, double v) {
    const Bristle b(deflection, v, kGive);
    EXPECT_GE(b.u * v, kGive * deflection * b.rate - 1e-15) << deflection << ", " << v;
  });
}

TEST(BristleLaw, GivesTheLevelAtMost) {
  ForEachState([](double deflection, double v) {
    const Bristle b(deflection, v, kGive);
    EXPECT_LE(std::abs(b.u), 1) << deflection << ", " << v;
    const double outwards = std::abs(deflection) == 1 ? b.rate * deflection : 0;
    EXPECT_LE(outwards, 0) << deflection << ", " << v;
  });
}

// Where sliding begins (1) and (2) go on: u and ζ' are the same from both sides.
TEST(BristleLaw, BeginsToSlideWithoutAJump) {
  for (const double deflection : {-0.5, 0.0, 0.9}) {
    const double v = (1 - deflection) * kGive / Bristle::kTime;
    const Bristle rests(deflection, v * (1 - 1e-9), kGive),
        slides(deflection, v * (1 + 1e-9), kGive);
    EXPECT_NEAR(rests.u, slides.u, 1e-8);
    EXPECT_NEAR(rests.rate, slides.rate, 1e-6);
  }
}

TEST(BristleLaw, HoldsWhatItHeldAtRest) {
  const Bristle b(0.9, 0, kGive);
  EXPECT_EQ(b.u, 0.9);
  EXPECT_EQ(b.rate, 0);
}

}  // namespace
}  // namespace continuum
