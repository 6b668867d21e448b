#include "models/spa/fold.h"

#include <gtest/gtest.h>

#include "models/spa/parameters.h"

namespace continuum {
namespace {

Spa<double> Actuator(double along, bool centred) {
  SpaFile file = ReadSpa(CONTINUUM_SOURCE "/models/spa/spa.yaml");
  if (centred) file.parameters.x_m = file.parameters.y_m = 0;
  file.options.gravity = {0, 0, along};
  return Spa<double>(file.parameters, file.options);
}

TEST(SpaFold, IsTheLargestPressureOfAStraightArm) {
  for (const double along : {9.81, 0.0, -9.81}) {
    const auto spa = Actuator(along, true);
    const double rest = SpaLargestAtRest(spa), fold = SpaStraightFold(spa);
    EXPECT_LT(rest, fold + 2) << along;
    // Newton's method, which has no slope there, misses the last of it.
    EXPECT_GT(rest, (1 - 5e-4) * fold) << along;
  }
}

// By hand: x_f = 44.697 mm, (2/3) 251.7274 x_f = 7.5010 N, m g/2 = 0.8858 N, 3 A = 93 mm².
TEST(SpaFold, HangingIsBelowTheSupplyAndStandingAbove) {
  EXPECT_NEAR(SpaStraightFold(Actuator(9.81, true)), 6.6151 / 93e-6, 5);
  EXPECT_LT(SpaLargestAtRest(Actuator(9.81, false)), 75e3);
  EXPECT_GT(SpaLargestStep(Actuator(-9.81, false)), 75e3);
}

TEST(SpaFold, AStepGivesWayBeforeTheRestDoes) {
  const auto spa = Actuator(9.81, false);
  const double step = SpaLargestStep(spa);
  EXPECT_LT(step, SpaLargestAtRest(spa) - 1e3);
  EXPECT_GT(step, 60e3);
}

}  // namespace
}  // namespace continuum
