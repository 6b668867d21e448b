#include "effects/directional_viscous.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

double Torque(double v, const Vec<double, 2>& law) {
  Port<double> port{};
  port.v = v;
  return DirectionalViscous::Eval<double>(port, {}, law).force;
}

TEST(DirectionalViscous, OpposesEachDirectionByItsOwnDamping) {
  const Vec<double, 2> law{0.2, 0.1};
  EXPECT_DOUBLE_EQ(Torque(0.4, law), (0.2 + 0.1) * 0.4);
  EXPECT_DOUBLE_EQ(Torque(-0.4, law), -(0.2 - 0.1) * 0.4);
  EXPECT_EQ(Torque(0, law), 0);
}

TEST(DirectionalViscous, WithoutADifferenceIsViscous) {
  for (const double v : {-2.0, -0.1, 0.1, 2.0}) EXPECT_DOUBLE_EQ(Torque(v, {0.2, 0}), 0.2 * v);
}

TEST(DirectionalViscous, TakesFromACycleWhatItsMeanDoes) {
  constexpr int kSteps = 10000;
  double work = 0, plain = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double v = 1.7 * std::sin(2 * std::numbers::pi * (k + 0.5) / kSteps);
    work += Torque(v, {0.2, 0.1}) * v, plain += 0.2 * v * v;
  }
  EXPECT_NEAR(work / plain, 1, 1e-12);
}

TEST(DirectionalViscous, NeverPushesWhereTheDifferenceIsNoMoreThanTheMean) {
  for (const double d : {-0.2, -0.05, 0.2})
    for (const double v : {-3.0, -1e-6, 1e-6, 3.0}) EXPECT_GE(Torque(v, {0.2, d}) * v, 0);
}

}  // namespace
}  // namespace continuum
