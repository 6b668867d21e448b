#include "effects/gear_friction.h"

#include <gtest/gtest.h>

#include "binding/dual.h"
#include "effects/load_friction.h"

namespace continuum {
namespace {

// tau_c, mu_m, mu_e, S_c, s_m, s_e, q_m, q_e, v_d, alpha, give.
const Vec<double, 11> kLaw{0.02, 0.1, 0.3, 0.05, 0.2, 0.05, 0.7, 0.4, 0.2, 1.35, 0};

FrictionState<double> At(double v, double motor, double others) { return {0, v, 0, motor, others}; }
double Level(double v, double motor, double others, const Vec<double, 11>& law = kLaw) {
  return GearFriction::Level<double>(At(v, motor, others), law);
}

TEST(GearFriction, WithEqualWeightsIsFrictionUnderTheTransmittedLoad) {
  const Vec<double, 11> law{0.02, 0.15, 0.15, 0, 0, 0, 0, 0, 0.2, 1.35, 0};
  for (const double motor : {-0.4, 0.1, 0.3}) {
    for (const double others : {-0.3, 0.0, 0.2}) {
      const double load = 0.5 * std::abs(motor - others);
      EXPECT_NEAR(Level(0.4, motor, others, law),
                  LoadFriction::Level<double>({0, 0.4, load}, {0.02, 0.3}), 1e-15);
    }
  }
}

TEST(GearFriction, WithoutALoadIsStribecks) {
  EXPECT_DOUBLE_EQ(Level(0, 0, 0), 0.02 + 0.05);
  EXPECT_DOUBLE_EQ(Level(0.2, 0, 0), 0.02 + 0.05 * std::exp(-1));
  EXPECT_NEAR(Level(50, 0, 0), 0.02, 1e-15);
}

TEST(GearFriction, FallsFromTheFirstMotionOnWhereAlphaIsBelowOne) {
  auto law = kLaw;
  law[9] = 0.45;
  EXPECT_DOUBLE_EQ(Level(0, 0, 0, law), 0.02 + 0.05);
  EXPECT_NEAR(Level(2e-3, 0, 0, law), 0.02 + 0.05 * std::exp(-std::pow(0.01, 0.45)), 1e-15);
  EXPECT_NEAR(Level(2, 0, 0, law), 0.02 + 0.05 * std::exp(-std::pow(10, 0.45)), 1e-15);
}

TEST(GearFriction, IsAlikeInBothDirections) {
  for (const double v : {0.0, 0.1, 0.7}) {
    EXPECT_EQ(Level(v, 0.3, -0.2), Level(-v, -0.3, 0.2));
    EXPECT_EQ(Level(v, 0.1, -0.2), Level(-v, 0.1, -0.2));
  }
}

// (3): the torque of the weaker side counts, and only where the two are opposed.
TEST(GearFriction, CountsTheSquareOfTheWeakerOfTwoOpposedTorques) {
  Vec<double, 11> plain = kLaw;
  plain[6] = plain[7] = 0;
  const auto more = [&](double motor, double others) {
    return Level(0, motor, others) - Level(0, motor, others, plain);
  };
  EXPECT_NEAR(more(0.5, -0.3), 0.4 * 0.09, 1e-15);
  EXPECT_NEAR(more(0.3, -0.5), 0.7 * 0.09, 1e-15);
  EXPECT_EQ(more(0.5, 0.3), 0);
  EXPECT_EQ(more(0.5, 0), 0);
}

TEST(GearFriction, HasTheSlopesOfItsDifferences) {
  constexpr double kStep = 1e-6;
  using T = Dual<14>;
  Vec<T, 11> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = T(kLaw[i], 3 + i);
  for (const std::array<double, 3>& at :
       {std::array{0.15, 0.3, -0.2}, {-0.15, 0.3, -0.5}, {0.4, 0.3, 0.2}}) {
    const double v = at[0], motor = at[1], others = at[2];
    const T level = GearFriction::Level<T>({T(0), T(v, 0), T(0), T(motor, 1), T(others, 2)}, p);
    const auto slope = [&](auto&& at) { return (at(kStep) - at(-kStep)) / (2 * kStep); };
    EXPECT_NEAR(level.d[0], slope([&](double h) { return Level(v + h, motor, others); }), 1e-8);
    EXPECT_NEAR(level.d[1], slope([&](double h) { return Level(v, motor + h, others); }), 1e-8);
    EXPECT_NEAR(level.d[2], slope([&](double h) { return Level(v, motor, others + h); }), 1e-8);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const auto by_parameter = [&](double h) {
        auto law = kLaw;
        law[i] += h;
        return Level(v, motor, others, law);
      };
      EXPECT_NEAR(level.d[3 + i], slope(by_parameter), 1e-8) << GearFriction::kParams[i].name;
    }
  }
}

TEST(GearFriction, HasFiniteSlopesAtRest) {
  using T = Dual<1>;
  Vec<T, 11> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = T(kLaw[i]);
  const T level = GearFriction::Level<T>({T(0), T(0, 0), T(0), T(0.3), T(-0.2)}, p);
  EXPECT_DOUBLE_EQ(level.a, Level(0, 0.3, -0.2));
  EXPECT_TRUE(std::isfinite(level.d[0]));
}

}  // namespace
}  // namespace continuum
