#include "sim/experiment/registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/replay/replay.h"
#include "support/measured_arm.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using testing::MeasuredArm;

class Registering : public ::testing::Test {
 protected:
  // A camera that looks from the side.
  static Registration Camera() {
    Registration r;
    r.frame = Registration::Part::kKnown;
    r.rotation = {1.2, -2.0, 0.7};
    r.translation = {0.3, -0.1, 1.5};
    return r;
  }
  static void ExpectNear(const Registration::Vector& found, const Registration::Vector& expected,
                         double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "component " << i;
  }
  // What the estimate says of an arm that a camera has measured.
  Experiment Found(const std::string& keys, const Registration& camera, double noise = 0) {
    Experiment e = arm_.Read("registration: " + keys + "\n");
    const ModelSpec system = ModelSpec::Load(e.model);
    MeasuredArm::Measure(e, system, camera, noise);
    replayed_ = Replay(e, system);
    return e;
  }
  void ExpectError(Experiment e, const std::string& text) const {
    const ModelSpec system = ModelSpec::Load(e.model);
    try {
      Replay(e, system);
      FAIL() << "nothing was said";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::kInput);
      EXPECT_THAT(error.what(), HasSubstr(text));
    }
  }

  MeasuredArm arm_;
  std::vector<Replayed> replayed_;
};

TEST_F(Registering, AFrameTurnedByAnyAngleIsFound) {
  const Experiment e = Found("{frame: estimate}", Camera());
  // The model follows commands that are straight between rows, the camera the true sines: 2e-5.
  ExpectNear(e.registration.rotation, Camera().rotation, 2e-4);
  ExpectNear(e.registration.translation, Camera().translation, 2e-5);
  const SplitError error = PooledError(e, replayed_);
  EXPECT_LT(error.train, 0.05) << "mm";
  EXPECT_LT(error.validate, 0.05) << "mm";
}

TEST_F(Registering, AMarkerBesideTheTipIsFoundWithItsFrame) {
  Registration camera = Camera();
  camera.marker = Registration::Part::kKnown;
  camera.offset["tip"] = {0.01, -0.02, 0.03};
  const Experiment e = Found("{frame: estimate, marker: estimate}", camera);
  ExpectNear(e.registration.offset.at("tip"), camera.offset["tip"], 2e-4);
  ExpectNear(e.registration.rotation, camera.rotation, 1e-3);
  EXPECT_LT(PooledError(e, replayed_).validate, 0.05) << "mm";
}

TEST_F(Registering, AClockThatIsLateOrEarlyIsFound) {
  for (const double shift : {0.023, -0.017, 0.2}) {
    Registration camera = Camera();
    camera.clock_shift = shift;
    const Experiment e = Found("{frame: estimate, clock_shift: estimate}", camera, 1e-4);
    EXPECT_NEAR(e.registration.clock_shift, shift, 2e-4);  // of rows 10 ms apart
    ExpectNear(e.registration.rotation, camera.rotation, 1e-3);
  }
}

TEST_F(Registering, WhatIsKnownIsApplied) {
  Registration camera = Camera();
  camera.offset[""] = {0.01, -0.02, 0.03};
  camera.clock_shift = 0.05;
  const Experiment e = Found(
      "{frame: {rotation: [1.2, -2.0, 0.7], translation: [0.3, -0.1, 1.5]}, "
      "marker: [0.01, -0.02, 0.03], clock_shift: 0.05}",
      camera);
  EXPECT_LT(PooledError(e, replayed_).train, 0.05) << "mm";
  const auto json = RegistrationJson(e.registration);
  EXPECT_EQ(json["frame"]["rotation"]["unit"], "rad");
  EXPECT_EQ(json["frame"]["translation"]["value"][2], 1.5);
  EXPECT_EQ(json["clock_shift"]["value"], 0.05);
  EXPECT_EQ(json["clock_shift"]["unit"], "s");
}

TEST_F(Registering, WhatIsWrittenIsReadAsItWas) {
  const Experiment e =
      Found("{frame: estimate, marker: estimate, clock_shift: estimate}", Camera());
  Experiment again = arm_.Read(RegistrationYaml(e.registration));
  EXPECT_EQ(again.registration.rotation, e.registration.rotation);
  EXPECT_EQ(again.registration.translation, e.registration.translation);
  EXPECT_EQ(again.registration.offset, e.registration.offset);
  EXPECT_EQ(again.registration.clock_shift, e.registration.clock_shift);
  EXPECT_FALSE(again.registration.estimates());
}

TEST_F(Registering, TheSameWorldNeedsNoKey) {
  Experiment e = arm_.Read("");
  const ModelSpec system = ModelSpec::Load(e.model);
  MeasuredArm::Measure(e, system, {});
  EXPECT_LT(PooledError(e, Replay(e, system)).train, 0.05) << "mm";
  EXPECT_TRUE(RegistrationJson(e.registration).is_null());
  EXPECT_EQ(RegistrationYaml(e.registration), "");
}

TEST_F(Registering, TooFewRowsAreNamed) {
  Experiment e = arm_.Read("registration: {frame: estimate}\n");
  for (auto& column : e.logs[0].measured) std::fill(column.begin() + 2, column.end(), std::nan(""));
  ExpectError(e, "at least three train rows of a position measured in x, y and z, found 2");
}

TEST_F(Registering, PointsOnALineAreNamed) {
  Experiment e = arm_.Read("registration: {frame: estimate}\n");
  for (auto& column : e.logs[0].input) {
    for (double& u : column) u *= 1e-4;  // the tip moves along a short, all but straight arc
  }
  for (double& u : e.logs[0].input[1]) u = 0;
  ExpectError(e, "simulated positions off one line, found a spread of");
}

TEST_F(Registering, AMarkerThatTheDataCannotPlaceIsNamed) {
  // Both links turn about y: an offset along y does what a translation along y does.
  Experiment e = arm_.Read("registration: {frame: estimate, marker: estimate}\n", "yy");
  ExpectError(e, "frame_translation_y, marker_tip_y do the same to all outputs");
}

TEST_F(Registering, MistakesInTheKeyAreNamed) {
  const auto read = [&](const std::string& keys) {
    try {
      const Experiment e = arm_.Read("registration: " + keys + "\n");
      CheckNames(e, ModelSpec::Load(e.model));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(read("{frame: guess}"), HasSubstr("registration.frame: expected estimate | {"));
  EXPECT_THAT(read("{camera: estimate}"), HasSubstr("camera"));
  EXPECT_THAT(read("{marker: [1, 2]}"), HasSubstr("expected three numbers, found 2"));
  EXPECT_THAT(read("{marker: {top: [0, 0, 0]}}"),
              HasSubstr("a position sensor (framepos) of the outputs, found 'top' (tip)"));
}

}  // namespace
}  // namespace continuum
