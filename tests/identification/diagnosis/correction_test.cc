#include "identification/diagnosis/correction.h"

#include <gtest/gtest.h>

#include "identification/candidates/typical_sizes.h"

namespace continuum {
namespace {

double OfSensor(const char* effect, const char* parameter, double null) {
  const Sizes sizes{.reading = 0.3};
  return MayBeOff(EffectNamed(effect), parameter, null, sizes, {});
}

// A link that is 1 % longer shifts what is seen at its end by 1 % of that.
TEST(Corrections, ConstantOfASensorIsOneUpToAShareOfItsLargestValue) {
  EXPECT_DOUBLE_EQ(OfSensor("sensor_bias", "bias", 0), 0.02 * 0.3);
  EXPECT_DOUBLE_EQ(OfSensor("sensor_bias", "bias[2]", 0), 0.02 * 0.3);
  EXPECT_DOUBLE_EQ(OfSensor("sensor_scale", "scale", 1), 0.05);
  EXPECT_EQ(OfSensor("sensor_drift", "rate", 0), 0);
}

// Masses 1 % and lengths 0.5 % off change what a joint moves by 2 %, whatever armature it has.
TEST(Corrections, ArmatureIsOneUpToAShareOfWhatTheJointMoves) {
  const Sizes sizes{.inertia = 0.02};
  const EffectInfo& effect = EffectNamed("armature");
  EXPECT_DOUBLE_EQ(MayBeOff(effect, "armature", 0, sizes, {}), 0.0004);
  EXPECT_DOUBLE_EQ(MayBeOff(effect, "armature", 0.001, sizes, {}), 0.0004);
  EXPECT_DOUBLE_EQ(MayBeOff(effect, "armature", 0.016, sizes, {}), 0.0008);
}

TEST(Corrections, LargestValueIsInTheUnitOfTheOutput) {
  Experiment e;
  e.channels.resize(2);
  e.channels[0].name = "x", e.channels[1].name = "z";
  for (auto& channel : e.channels) channel.factor = 1000;  // from m to mm
  Log log;
  log.measured = {{1, -2}, {250, -300}};
  e.logs = {log};
  EXPECT_DOUBLE_EQ(ReadingSize(e, {"x", "z"}), 0.3);
  EXPECT_DOUBLE_EQ(ReadingSize(e, {"x"}), 0.002);
  EXPECT_DOUBLE_EQ(ReadingSize(e, {"none"}), 1);
}

}  // namespace
}  // namespace continuum
