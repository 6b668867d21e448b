#include "sim/model/attribute_bounds.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::string& target, const std::string& attribute, double value) {
  try {
    RequirePossible({target, attribute, value});
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(AttributeBounds, NameAValueThatNoMachineHasWithTheRange) {
  EXPECT_EQ(Refusal("joint:q", "damping", -5),
            "joint:q: damping: expected a number >= 0 N*m*s/rad (turning) or N*s/m, found -5");
  EXPECT_EQ(Refusal("joint:q", "stiffness", 1e300),
            "joint:q: stiffness: expected a number <= 1e+12, found 1e+300");
  EXPECT_THAT(Refusal("joint:q", "stiffness", -1e300), HasSubstr("a number >= -1e+12, found"));
  EXPECT_THAT(Refusal("plugin:rub", "tau_c", 1e300), HasSubstr("a number <= 1e+12, found"));
  EXPECT_THAT(Refusal("option", "timestep", 0), HasSubstr("a number > 0 s, found 0"));
  EXPECT_EQ(Refusal("joint:q", "stiffness", -20), "no error");
}

TEST(AttributeBounds, OfANativeEffectAreThoseOfItsCard) {
  EXPECT_EQ(Refusal("joint:q", "effect:elastic_gear.d", -5),
            "joint:q: effect:elastic_gear.d: expected a number >= 0 N*m*s/rad, found -5");
  EXPECT_EQ(Refusal("actuator:u", "effect:torque_limit", 0),
            "actuator:u: effect:torque_limit: expected a number > 0 N*m, found 0");
  EXPECT_EQ(Refusal("body:b", "effect:mounting_angle.yaw", 60),
            "body:b: effect:mounting_angle.yaw: expected a number <= 3 rad, found 60");
  EXPECT_THAT(Refusal("site:s", "effect:site_place.dx", 1e300), HasSubstr("<= 1e+12 m, found"));
  EXPECT_THAT(Refusal("body:b", "effect:link_mass", -1), HasSubstr("a number >= 0, found -1"));
}

TEST(AttributeBounds, AFactorKeepsTheSignOfWhatIsNeverNegative) {
  const auto refused = [](const std::string& attribute, double by, Change::Operation operation) {
    try {
      RequirePossible({"joint:q", attribute, by, operation});
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused("damping", -2, Change::Operation::kScale));
  EXPECT_TRUE(refused("damping", 1e300, Change::Operation::kScale));
  EXPECT_FALSE(refused("stiffness", -2, Change::Operation::kScale));
  EXPECT_FALSE(refused("damping", -2, Change::Operation::kAdd));
}

TEST(AttributeBounds, AnEndOfARangeMaySayThatThereIsNoLimit) {
  EXPECT_EQ(Refusal("actuator:u", "forcerange[1]", 1e300), "no error");
  EXPECT_EQ(Refusal("actuator:u", "effect:torque_limit", 1e300), "no error");
}

}  // namespace
}  // namespace continuum
