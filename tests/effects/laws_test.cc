#include <cmath>

#include <gtest/gtest.h>

#include "effects/all.h"

namespace continuum {
namespace {

// With v > 0 from z = 0, (1) gives F(x) = f (1 − exp(−σ x/f)).
TEST(Dahl, PullFollowsTheClosedForm) {
  const Vec<double, 2> p{2e4, 3.0};
  for (const double x : {1e-5, 1e-4, 1e-3}) {
    const auto z = Dahl::Step<double>({0.0}, {0, 0.01}, x / 0.01, p);
    EXPECT_NEAR(3.0 * z[0], 3.0 * (1 - std::exp(-2e4 * x / 3.0)), 1e-12);
  }
}

TEST(Dahl, ForceDependsOnThePathNotOnSpeed) {
  const Vec<double, 2> p{2e4, 3.0};
  const auto slow = Dahl::Step<double>({0.2}, {0, 0.001}, 0.1, p);
  const auto fast = Dahl::Step<double>({0.2}, {0, 0.1}, 0.001, p);
  EXPECT_NEAR(slow[0], fast[0], 1e-12);
}

TEST(Stribeck, BreaksAwayHigherThanItSlides) {
  const Vec<double, 5> p{0.0314, 0.0413, 0.7472, 0.2994, 1000};
  EXPECT_DOUBLE_EQ(Stribeck::Level<double>({0, 0, 0}, p), 0.0413 * 1.7472);
  EXPECT_NEAR(Stribeck::Level<double>({0, 5, 0}, p), 0.0413, 1e-12);
  EXPECT_NEAR(Stribeck::Literal(0.5, p), 0.0314 * 0.5 + Stribeck::Level<double>({0, 0.5, 0}, p),
              1e-12);
  EXPECT_EQ(Stribeck::Literal(0.0, p), 0);
}

TEST(Capstan, BothLawsAgreeForSmallAngles) {
  const Vec<double, 4> p{0.3, 0, 0, 0};
  for (const double theta : {1e-3, 1e-2}) {
    EXPECT_NEAR(Capstan::Band(theta, 0, p), Capstan::Band(theta, 1, p), theta * theta * theta);
  }
  EXPECT_EQ(Capstan::Band(0.0, 1, p), 0);
}

TEST(Capstan, ANegativeFrictionPolynomialIsNoFriction) {
  EXPECT_EQ(Capstan::Band(1.0, 0, Vec<double, 4>{0.1, -0.5, 0, 0}), 0);
}

TEST(Backlash, IsADeadZone) {
  const Vec<double, 1> p{0.2};
  EXPECT_EQ(Backlash::Eval(0.05, p), 0);
  EXPECT_DOUBLE_EQ(Backlash::Eval(0.3, p), 0.2);
  EXPECT_DOUBLE_EQ(Backlash::Eval(-0.3, p), -0.2);
}

}  // namespace
}  // namespace continuum
