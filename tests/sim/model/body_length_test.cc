#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/model/model_spec.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::DoubleNear;
using ::testing::Pointwise;

constexpr double kLength = 0.3, kScale = 1.5;  // m, 1

// A bar that turns about its end, with holes for a cable beside its axis and a wheel at its far
// end. The wheel may be written in a frame that is turned.
std::string Bar(double length, bool in_frame) {
  const std::string place = in_frame ? fmt::format(R"(<frame pos=".1 0 0" euler="0 0 90">
        <body name="wheel" pos="0 {} 0" euler="0 0 -90">)",
                                                   0.1 - length)
                                     : fmt::format(R"(<body name="wheel" pos="{} 0 0">)", length);
  return fmt::format(
      R"(<mujoco><worldbody><site name="far" pos="1 0 1"/><body name="bar"><joint name="j" axis="0 1 0"/>
      <geom type="box" size="{0} .01 .02" pos="{0} 0 0" mass=".4" contype="0"/>
      <site name="near" pos="{0} 0 .02"/><site name="end" pos="{1} .02 .1"/>{2}
      <joint name="k" axis="0 0 1"/><geom size=".03" mass=".1" contype="0"/></body>{3}
      </body></worldbody><tendon><spatial name="t"><site site="far"/><site site="end"/><site site="near"/>
      </spatial></tendon></mujoco>)",
      length / 2, length, place, in_frame ? "</frame>" : "");
}

// The same with the inertia of the bar written down, so that its geom only looks.
std::string Weighed(std::string xml) {
  const std::string weight = R"(<inertial pos=".15 0 0" mass=".4" diaginertia="1e-3 2e-3 2e-3"/>)";
  xml.insert(xml.find("<joint name=\"j\""), weight);
  const std::string wheel = R"(<inertial pos="0 0 0" mass=".1" diaginertia="1e-4 1e-4 1e-4"/>)";
  xml.insert(xml.find("<joint name=\"k\""), wheel);
  return xml;
}

// What moves the model at a bent pose: inertia, weight, spin forces, and the cable.
std::vector<double> Motion(const ModelAndData& machine) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  for (int i = 0; i < m.nv; ++i) d.qpos[i] = 0.3 + 0.2 * i, d.qvel[i] = 1 - 0.4 * i;
  mj_forward(&m, &d);
  std::vector<double> all(m.nv * m.nv);
  mj_fullM(&m, &d, all.data());
  all.insert(all.end(), d.qfrc_bias, d.qfrc_bias + m.nv);
  if (m.ntendon > 0) all.push_back(d.ten_length[0]);
  return all;
}

TEST(BodyLength, AStretchedBarMovesAsABarOfThatLength) {
  const std::vector<Change> longer{{"body:bar", "effect:link_length", kScale}};
  const auto want = Motion(ModelSpec::Parse(Bar(kScale * kLength, false)).Build());
  for (const bool in_frame : {false, true}) {
    const ModelSpec bar = ModelSpec::Parse(Bar(kLength, in_frame));
    EXPECT_THAT(Motion(bar.Build(longer)), Pointwise(DoubleNear(1e-12), want));
  }
}

TEST(BodyLength, LeavesNothingBehind) {
  const ModelSpec bar = ModelSpec::Parse(Bar(kLength, true));
  const std::string before = bar.Xml();
  const auto motion = Motion(bar.Build());
  const auto longer = Motion(bar.Build({{{"body:bar", "effect:link_length", kScale}}}));
  EXPECT_NE(longer, motion);
  EXPECT_EQ(Motion(bar.Build()), motion);
  EXPECT_EQ(bar.Xml(), before);
}

TEST(BodyLength, AnExtendedModelHasIt) {
  const std::vector<Change> longer{{"body:bar", "effect:link_length", kScale}};
  const ModelSpec bar = ModelSpec::Parse(Bar(kLength, true));
  const auto there = Motion(ModelSpec::Parse(bar.With(longer, {}).Xml()).Build());
  EXPECT_THAT(there, Pointwise(DoubleNear(1e-12), Motion(bar.Build(longer))));
}

// MuJoCo deletes geoms that only look, as it compiles such a model.
TEST(BodyLength, MovesNoGeomThatIsLeftOut) {
  std::string xml = Bar(kLength, false);
  const std::string looks = "<geom type='sphere' size='.02' mass='0' contype='0' conaffinity='0'/>";
  for (int i = 0; i < 20; ++i) xml.insert(xml.find("<site name=\"near\""), looks);
  ModelSpec arm = ModelSpec::Parse(Weighed(xml));
  const std::vector<Change> longer{{"body:bar", "effect:link_length", kScale}};
  const auto seen = Motion(arm.Build(longer)), before = Motion(arm.Build());
  arm.DropVisuals();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(Motion(arm.Build(longer)), seen);
    EXPECT_EQ(Motion(arm.Build()), before);
  }
}

TEST(BodyLength, TheJointStaysWhereItIs) {
  const ModelSpec bar = ModelSpec::Parse(R"(<mujoco><worldbody><body name="bar">
      <joint axis="0 1 0" pos="0 0 -.1"/><geom type="capsule" size=".01" fromto="0 0 -.1 0 0 .1" mass=".4"/>
      <body name="tip" pos="0 0 .1"><geom size=".01" mass=".1"/></body></body></worldbody></mujoco>)");
  const ModelAndData longer = bar.Build({{{"body:bar", "effect:link_length", 2}}});
  EXPECT_NEAR(longer.model->jnt_pos[2], -0.1, 1e-15);
  EXPECT_NEAR(longer.model->body_pos[3 * 2 + 2], 0.3, 1e-15);
  EXPECT_NEAR(longer.model->body_ipos[3 * 1 + 2], 0.1, 1e-15);
  EXPECT_NEAR(longer.model->body_mass[1], 0.4, 1e-15);
}

TEST(BodyLength, ABodyWithoutAnAxisStaysAsItIs) {
  const ModelSpec ball = ModelSpec::Parse(R"(<mujoco><worldbody><body name="ball"><freejoint/>
      <geom size=".1" mass="1"/></body></worldbody></mujoco>)");
  EXPECT_EQ(Motion(ball.Build({{{"body:ball", "effect:link_length", 2}}})), Motion(ball.Build()));
}

}  // namespace
}  // namespace continuum
