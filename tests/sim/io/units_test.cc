#include "sim/io/units.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Units, ProductsAndQuotientsHaveAFactorAndADimension) {
  const Unit torque = ParseUnit("N*mm", "");
  EXPECT_DOUBLE_EQ(torque.factor, 1e-3);
  EXPECT_THAT(torque.dimension, ElementsAre(2, 1, -2, 0));
  const Unit acceleration = ParseUnit("mm/s^2", "");
  EXPECT_DOUBLE_EQ(acceleration.factor, 1e-3);
  EXPECT_THAT(acceleration.dimension, ElementsAre(1, 0, -2, 0));
  EXPECT_DOUBLE_EQ(UnitFactor("deg/s", ""), std::numbers::pi / 180);
  EXPECT_EQ(ParseUnit("V*A", "").dimension, ParseUnit("W", "").dimension);
  EXPECT_EQ(ParseUnit("N/m^2", "").dimension, ParseUnit("Pa", "").dimension);
  EXPECT_EQ(ParseUnit("rpm", "").dimension, ParseUnit("rad/s", "").dimension);
}

TEST(Units, OfAnotherDimensionAreRefusedAndCountsNever) {
  for (const char* fits : {"mm", "um", "1", "%", "step"}) RequireUnitLike("m", fits, "here");
  RequireUnitLike("Nm", "J", "here");
  for (const char* wrong : {"rad", "kg", "m/s", "m^2", "1/s"}) {
    try {
      RequireUnitLike("m", wrong, "file:3: unit");
      ADD_FAILURE() << wrong;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("file:3: unit: expected a unit like 'm', found '" +
                                      std::string(wrong) + "'"));
    }
  }
}

}  // namespace
}  // namespace continuum
