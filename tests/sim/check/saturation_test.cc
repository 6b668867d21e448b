#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.h"

namespace continuum {
namespace {

using namespace testing;  // the bench
using ::testing::HasSubstr;

TEST(Saturation, OfASensorIsNamed) {
  Log log = Record({Sines, Sines});
  for (double& q : Column(log, "q2")) q = std::min(q, 0.5);
  const Finding f = Only(log, "saturation", "q2");
  EXPECT_THAT(f.text, HasSubstr("largest value 0.5 rad"));
}

// What a controller asks for, noise and all, as its amplifier takes it.
Recipe Clipped(double limit, double held = 0) {
  Recipe recipe;
  recipe.u2 = [=](double t) {
    const double at = held > 0 ? held * std::floor(t / held + 1e-9) : t;
    const double noise = 0.1 * std::sin(1e4 * at * at);
    return std::clamp(Sines(at) + noise, -limit, limit);
  };
  return recipe;
}

TEST(Saturation, OfAnInputIsToldHoweverItMovesInBetween) {
  for (const double held : {0.0, 0.05}) {
    const auto all = CheckLogs(With(Record(Clipped(0.8, held))));
    EXPECT_TRUE(Bad(all).empty()) << Report(all);
    const Finding* const f = Find(all, "saturation", "u2");
    ASSERT_NE(f, nullptr) << "held " << held << "\n" << Report(all);
    EXPECT_THAT(f->text, HasSubstr("value -0.8 rad for "));
    EXPECT_THAT(f->text, HasSubstr("saturated, or held there on purpose"));
  }
}

TEST(Saturation, IsNotSeenInInputsThatTurnOrStep) {
  const Command stairs = [](double t) { return 0.1 * std::floor(10 * Sines(t)); };
  for (const Command& u : {Command(Sines), Command(Steps), stairs}) {
    Recipe recipe;
    recipe.u2 = u;
    recipe.noise = 0;
    const auto all = CheckLogs(With(Record(recipe)));
    EXPECT_EQ(Find(all, "saturation", "u2"), nullptr) << Report(all);
  }
}

TEST(Saturation, AtALimitOfTheActuatorIsTold) {
  const ModelSpec system = ModelSpec::Parse(R"(<mujoco><worldbody>
      <body><joint name="a"/><geom size=".1"/></body>
      <body pos="1 0 0"><joint name="b"/><geom size=".1"/></body></worldbody>
    <actuator><motor name="m1" joint="a"/><motor name="m2" joint="b" ctrlrange="-0.8 0.8"/></actuator>
    <sensor><jointpos name="q1" joint="a"/><jointvel name="v1" joint="a"/><jointpos name="q2" joint="b"/></sensor>
  </mujoco>)");
  const auto of = [&](const Recipe& recipe) {
    return CheckAgainstModel(With(Record(recipe)), system);
  };
  const auto all = of(Clipped(0.8));
  const Finding* const f = Find(all, "at_limit", "u2");
  ASSERT_NE(f, nullptr) << Report(all);
  EXPECT_THAT(f->text, HasSubstr("smallest that actuator 'm2' takes, -0.8 rad, in "));
  EXPECT_EQ(Find(of(Clipped(0.7)), "at_limit", "u2"), nullptr);
}

}  // namespace
}  // namespace continuum
