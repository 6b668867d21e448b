#include "effects/torque_ripple.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

const Vec<double, 3> kLaw{0.03, -0.02, 7};

Reply<double, 0> At(double q) { return TorqueRipple::Eval<double>({q, 0.5}, {}, kLaw); }

TEST(TorqueRipple, RepeatsAsOftenAsItSays) {
  for (const double q : {-2.0, 0.1, 1.0})
    EXPECT_NEAR(At(q).force, At(q + 2 * M_PI / 7).force, 1e-15);
  EXPECT_DOUBLE_EQ(At(0).force, 0.03);
  EXPECT_NEAR(At(M_PI / 14).force, -0.02, 1e-15);
}

TEST(TorqueRipple, IsTheSlopeOfWhatItStores) {
  constexpr double kStep = 1e-5;
  for (double q = -3; q < 3; q += 0.37) {
    const double slope = (At(q + kStep).stored - At(q - kStep).stored) / (2 * kStep);
    EXPECT_NEAR(At(q).force, slope, 1e-10);
  }
}

TEST(TorqueRipple, GivesBackAllOverATurn) {
  EXPECT_NEAR(At(0.3).stored, At(0.3 + 2 * M_PI).stored, 1e-15);
}

}  // namespace
}  // namespace continuum
