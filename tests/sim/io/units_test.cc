#include "sim/io/units.h"

#include <map>
#include <numbers>
#include <string>

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

// As UDUNITS-2 reads them.
TEST(Units, AreReadInEverySpellingOfAProduct) {
  const double degree = std::numbers::pi / 180;
  const std::map<std::string, double> same[] = {
      {{"N*m", 1},
       {"N.m", 1},
       {"N m", 1},
       {"N\u00B7m", 1},
       {"N\u22C5m", 1},
       {"N-m", 1},
       {"Nm", 1},
       {"newton meter", 1},
       {"newton-metres", 1},
       {"kg m2 s-2", 1},
       {"kg*m^2/s^2", 1},
       {"N*mm", 1e-3},
       {"kg.m\u00B2.s\u207B\u00B2", 1},
       {"kg m**2/(s*s)", 1},
       {"mNm", 1e-3},
       {"N cm", 1e-2},
       {"Ncm", 1e-2},
       {"lbf in", 0.1129848290276167},
       {"kgf*cm", 0.0980665},
       {"mJ", 1e-3}},
      {{"rad/s", 1},
       {"rad s-1", 1},
       {"radians per second", 1},
       {"deg/s", degree},
       {"degrees/second", degree},
       {"\u00B0/s", degree},
       {"dps", degree},
       {"rpm", std::numbers::pi / 30},
       {"rev/min", std::numbers::pi / 30},
       {"turns per minute", std::numbers::pi / 30},
       {"mrad/ms", 1}},
      {{"Pa", 1},
       {"N/m2", 1},
       {"psi", 6894.757293168361},
       {"lbf/in^2", 6894.757293168361},
       {"hPa", 100},
       {"mbar", 100},
       {"cmH2O", 98.0665},
       {"atm", 101325},
       {"kilopascals", 1e3}},
      {{"m", 1},
       {"\u00B5m", 1e-6},
       {"\u03BCm", 1e-6},
       {"inches", 0.0254},
       {"100 mm", 0.1},
       {"millimeters", 1e-3}},
      {{"rad", 1},
       {"degrees", degree},
       {"arcdeg", degree},
       {"gon", 0.9 * degree},
       {"arc_minute", degree / 60},
       {"turn", 360 * degree}},
      {{"s", 1}, {"ns", 1e-9}, {"nanoseconds", 1e-9}, {"min", 60}, {"h", 3600}, {"1e-6 s", 1e-6}},
      {{"m/s^2", 1}, {"m.s-2", 1}, {"m s^-2", 1}, {"g0", 9.80665}, {"mm/s/s", 1e-3}}};
  for (const auto& units : same) {
    const auto dimension = ParseUnit(units.begin()->first, "").dimension;
    for (const auto& [text, factor] : units) {
      const Unit unit = ParseUnit(text, "");
      EXPECT_NEAR(unit.factor, factor, 1e-12 * factor) << text;
      EXPECT_EQ(unit.dimension, dimension) << text;
      EXPECT_FALSE(unit.any) << text;
    }
  }
}

TEST(Units, ThatAreNoProductOfNamesAreRefused) {
  for (const char* wrong :
       {"", " ", "/", "N/", "N*", "(N", "N)", "N^", "N^0", "N^10", "m^1.5", "furlong", "degC",
        "N+m", "((((((((((m))))))))))", "1e200 m", "0 m", "kkg", "meterss"}) {
    try {
      ParseUnit(wrong, "file:3: unit");
      ADD_FAILURE() << wrong;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("file:3: unit: expected a unit")) << wrong;
    }
  }
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
  try {
    RequireUnitLike("m/s^2", "g", "here");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("standard gravity is g0"));
  }
}

}  // namespace
}  // namespace continuum
