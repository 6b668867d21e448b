#include "effects/torque_limit.h"

#include <string>

#include <gtest/gtest.h>

namespace continuum {
namespace {

struct Actuator {
  std::string attribute;
  double value = 0;
  void Set(std::string_view name, double to) { attribute = name, value = to; }
};

TEST(TorqueLimit, IsARangeOfTheActuatorsForce) {
  Actuator actuator;
  TorqueLimit::Apply(actuator, {0.4});
  EXPECT_EQ(actuator.attribute, "force_limit");
  EXPECT_EQ(actuator.value, 0.4);
}

TEST(TorqueLimit, WithoutALimitLeavesTheActuatorAsItIs) {
  Actuator actuator;
  TorqueLimit::Apply(actuator, {kInfinity});
  EXPECT_EQ(actuator.attribute, "");
}

}  // namespace
}  // namespace continuum
