#include "identification/candidates/parameter_size.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "binding/effect_catalog.h"
#include "error.h"
#include "support/law_suite.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

const Sizes kSizes{.torque = 0.7,
                   .angle = 1.3,
                   .velocity = 2.1,
                   .tension = 31,
                   .mass = 0.11,
                   .robot = 0.9,
                   .inertia = 0.013,
                   .length = 0.17,
                   .input = 5.5,
                   .period = 0.012,
                   .step = 0.002};

ParameterSize SizeOfUnit(const std::string& unit, Place place, const Sizes& sizes = kSizes) {
  return SizeOf({"x", unit, -kInfinity, kInfinity, 0, 0}, place, sizes);
}

// To the last bit: results that are published stand.
TEST(ParameterSize, OfAUnitWithARuleOfItsOwnIsWhatItAlwaysWas) {
  struct Row {
    std::string unit;
    std::array<double, 4> size;
    double reach, typical;
  };
  constexpr Place kAt[] = {Place::kJoint, Place::kTendon, Place::kActuator, Place::kBody};
  const Row rows[] = {
      {"1", {1, 1, 1, 1}, 10, 0.1},
      {"N*m", {0.7, 31, 0.7, 0.7}, 3, 0.05},
      {"N", {0.7, 31, 0.7, 0.7}, 3, 0.05},
      {"rad", {1.3, 0.029354838709677419, 1.3, 1.3}, 3, 0.02},
      {"rad/s", {2.1, 0.047419354838709675, 20.833333333333332, 2.1}, 3, 0.05},
      {"N*m*s/rad",
       {0.33333333333333331, 653.74149659863951, 0.33333333333333331, 0.33333333333333331},
       3,
       0.05},
      {"N*m/rad",
       {26.92307692307692, 52802.197802197799, 26.92307692307692, 26.92307692307692},
       3,
       0.05},
      {"N/m",
       {26.92307692307692, 52802.197802197799, 26.92307692307692, 26.92307692307692},
       3,
       0.05},
      {"N*m/rad^3",
       {0.31861629494765586, 0.31861629494765586, 0.31861629494765586, 0.31861629494765586},
       100,
       0.05},
      {"kg", {0.11, 0.11, 0.11, 0.11}, 40.909090909090907, 0.05},
      {"kg*m^2", {0.013, 0.013, 0.013, 0.013}, 3, 0.05},
      {"1/rad",
       {38.46153846153846, 1703.2967032967033, 38.46153846153846, 38.46153846153846},
       3,
       0.05},
      {"m/N",
       {0.00032258064516129032, 0.00032258064516129032, 0.00032258064516129032,
        0.00032258064516129032},
       3,
       0.05},
      {"s", {0.048, 0.048, 0.048, 0.048}, 25, 0.125},
      {"input", {5.5, 5.5, 5.5, 5.5}, 3, 0.05},
      {"m", {0.17, 0.17, 0.17, 0.17}, 3, 0.05}};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size.size(); ++i) {
      const ParameterSize found = SizeOfUnit(row.unit, kAt[i]);
      EXPECT_EQ(found.size, row.size[i]) << row.unit << " " << PlaceName(kAt[i]);
      EXPECT_EQ(found.reach, row.reach) << row.unit;
      EXPECT_EQ(found.typical, row.typical) << row.unit;
    }
  }
}

TEST(ParameterSize, OfAnyOtherUnitIsTheProductOfItsFactors) {
  const double time = 1.3 / 2.1;
  EXPECT_DOUBLE_EQ(SizeOfUnit("m^2", Place::kBody).size, 0.17 * 0.17);
  EXPECT_DOUBLE_EQ(SizeOfUnit("kg/s", Place::kBody).size, 0.11 / time);
  EXPECT_DOUBLE_EQ(SizeOfUnit("N/m^3", Place::kBody).size, 0.7 / std::pow(0.17, 4));
  EXPECT_DOUBLE_EQ(SizeOfUnit("1/rad^2", Place::kJoint).size, 1 / (1.3 * 1.3));
  EXPECT_DOUBLE_EQ(SizeOfUnit("N*m*s^3/rad^3", Place::kJoint).size, 0.7 / std::pow(2.1, 3));
  EXPECT_DOUBLE_EQ(SizeOfUnit("J", Place::kJoint).size, SizeOfUnit("N*m", Place::kJoint).size);
  EXPECT_DOUBLE_EQ(SizeOfUnit("m*N/rad", Place::kJoint).size,
                   SizeOfUnit("N*m/rad", Place::kJoint).size);
}

// What an experiment in grams and millimetres would find is the same quantity.
TEST(ParameterSize, OfAProductFollowsTheUnitsOfTheExperiment) {
  const auto in = [](double si, std::string_view unit) {
    return si * testing::FactorOf(unit, testing::kOtherUnits);
  };
  Sizes other = kSizes;
  other.torque = in(kSizes.torque, "N*m"), other.velocity = in(kSizes.velocity, "rad/s");
  other.tension = in(kSizes.tension, "N"), other.length = in(kSizes.length, "m");
  other.mass = in(kSizes.mass, "kg"), other.period = in(kSizes.period, "s");
  for (const std::string unit : {"m^2", "kg/s", "N/m^3", "1/rad^2", "N*m*s^3/rad^3", "N*s/m"}) {
    const double size = SizeOfUnit(unit, Place::kBody).size;
    EXPECT_NEAR(SizeOfUnit(unit, Place::kBody, other).size, in(size, unit), 1e-12 * in(size, unit))
        << unit;
  }
  // A tendon has metres for radians.
  const double size = SizeOfUnit("N*m*s^3/rad^3", Place::kTendon).size;
  EXPECT_NEAR(SizeOfUnit("N*m*s^3/rad^3", Place::kTendon, other).size, in(size, "N*s^3/m^3"),
              1e-12 * in(size, "N*s^3/m^3"));
}

// A cable wraps a contact by about the angle of the joint beside it, not by its own travel: a
// coefficient that says how friction grows with that angle is a friction coefficient over it.
TEST(ParameterSize, AlongACableIsOverTheAngleOfAJoint) {
  const auto size = [](const std::string& unit) {
    return SizeAlongCable({"x", unit, -kInfinity, kInfinity, 0, 0}, kSizes).size;
  };
  EXPECT_EQ(size("1"), 1);
  EXPECT_DOUBLE_EQ(size("1/rad"), 1 / 1.3);
  EXPECT_DOUBLE_EQ(size("1/rad^2"), 1 / (1.3 * 1.3));
}

TEST(ParameterSize, OfAForceOnABodyIsThatOfATorqueOverItsLever) {
  Sizes sizes = kSizes;
  sizes.lever = 0.25;
  for (const Place place : {Place::kBody, Place::kSite})
    EXPECT_DOUBLE_EQ(SizeOfUnit("N", place, sizes).size, 0.7 / 0.25);
  EXPECT_DOUBLE_EQ(SizeOfUnit("N", Place::kTendon, sizes).size, 31);
}

TEST(ParameterSize, OfAnUnknownUnitIsAnErrorThatNamesIt) {
  for (const std::string unit : {"furlong", "N*m/deg", "rad^x", ""}) {
    try {
      SizeOfUnit(unit, Place::kJoint);
      ADD_FAILURE() << "'" << unit << "' has a size";
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("'" + unit + "'"));
      EXPECT_THAT(e.what(), HasSubstr("parameter x"));
    }
  }
}

template <class E>
struct EveryEffectOfTheModel : ::testing::Test {};
template <class E>
using IsOfTheModel = std::bool_constant<!MeasureLaw<E>>;
using OfTheModel = All::Into<testing::Where<IsOfTheModel>::Of>;
TYPED_TEST_SUITE(EveryEffectOfTheModel, OfTheModel::Into<testing::Types>, testing::EffectName);

TYPED_TEST(EveryEffectOfTheModel, HasParametersOfKnownSizeAtAllItsPlaces) {
  for (const Place place : TypeParam::kPlaces) {
    for (const Param& p : TypeParam::kParams) {
      const double size = SizeOf(p, place, kSizes).size;
      EXPECT_TRUE(std::isfinite(size) && size > 0) << p.name << " at " << PlaceName(place);
    }
  }
}

}  // namespace
}  // namespace continuum
