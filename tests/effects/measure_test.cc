// What sensors and clocks do to a recorded signal.
#include <cmath>

#include <gtest/gtest.h>

#include "effects/all.h"

namespace continuum {
namespace {

double Signal(double t) { return std::sin(3 * t) + 0.2 * t; }

TEST(Sensor, BiasScaleAndDriftAreThoseOfTheMeasurementEquation) {
  for (const double t : {0.0, 0.4, 2.0}) {
    EXPECT_DOUBLE_EQ(SensorBias::Eval<double>(Signal, t, {0.3}), Signal(t) + 0.3);
    EXPECT_DOUBLE_EQ(SensorScale::Eval<double>(Signal, t, {1.1}), 1.1 * Signal(t));
    EXPECT_DOUBLE_EQ(SensorDrift::Eval<double>(Signal, t, {-0.05}), Signal(t) - 0.05 * t);
  }
}

TEST(Sensor, DelayReportsWhatWas) {
  EXPECT_DOUBLE_EQ(SensorDelay::Eval<double>(Signal, 1.0, {0.25}), Signal(0.75));
}

TEST(Clock, SkewStretchesTimeFromTheBeginningOfTheLog) {
  EXPECT_EQ(ClockSkew::Eval<double>(Signal, 0.0, {0.01}), Signal(0));
  EXPECT_DOUBLE_EQ(ClockSkew::Eval<double>(Signal, 2.0, {0.01}), Signal(2.02));
}

TEST(Sensor, LawsApplyOneAfterTheOther) {
  // scale y(t − delay) + bias + rate t
  const auto late = [](double t) { return SensorDelay::Eval<double>(Signal, t, {0.1}); };
  const auto scaled = [&](double t) { return SensorScale::Eval<double>(late, t, {2}); };
  const auto biased = [&](double t) { return SensorBias::Eval<double>(scaled, t, {0.5}); };
  EXPECT_DOUBLE_EQ(SensorDrift::Eval<double>(biased, 1.0, {0.01}), 2 * Signal(0.9) + 0.5 + 0.01);
}

TEST(Misalignment, TurnsAboutItsAxis) {
  const auto y = [](double) { return Vec<double, 3>{1, 2, 3}; };
  const auto turned = Misalignment::Eval<double>(y, 0, {M_PI / 2, 0, 0, 5});
  EXPECT_NEAR(turned[0], -2, 1e-15);
  EXPECT_NEAR(turned[1], 1, 1e-15);
  EXPECT_NEAR(turned[2], 3, 1e-15);
  // A third of a turn about (1, 1, 1) permutes the axes.
  const auto third = Misalignment::Eval<double>(y, 0, {2 * M_PI / 3, 1, 1, 1});
  EXPECT_NEAR(third[0], 3, 1e-14);
  EXPECT_NEAR(third[1], 1, 1e-14);
  EXPECT_NEAR(third[2], 2, 1e-14);
}

TEST(Misalignment, KeepsTheLengthForAnyAxis) {
  const auto y = [](double) { return Vec<double, 3>{0.3, -0.7, 0.2}; };
  const auto turned = Misalignment::Eval<double>(y, 0, {0.4, -1, 2, 0.5});
  EXPECT_NEAR(std::hypot(turned[0], turned[1], turned[2]), std::hypot(0.3, 0.7, 0.2), 1e-15);
}

}  // namespace
}  // namespace continuum
