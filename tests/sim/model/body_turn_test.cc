#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/model/model_spec.h"

namespace continuum {
namespace {

using ::testing::DoubleNear;
using ::testing::Pointwise;

// Two links; the second one mounted with some Euler angles (x, then y, then z, all of the parent's
// axes), its joint beside its origin, in a frame or not.
std::string Arm(const std::string& mounted) {
  return R"(<mujoco><compiler eulerseq="XYZ" angle="radian"/><worldbody><body name="one">
      <joint name="i" axis="0 1 0"/><geom type="capsule" size=".01" fromto="0 0 0 .2 0 0" mass=".3"/>)" +
         mounted + R"(</body></worldbody><sensor>
      <framepos objtype="site" objname="tip"/><framequat objtype="site" objname="tip"/></sensor></mujoco>)";
}
std::string Second(const std::string& place) {
  return "<body name=\"two\" " + place +
         R"(><joint name="j" axis="0 1 0"/><geom type="capsule" size=".01" fromto="0 0 0 .2 .01 0"
         mass=".2"/><site name="tip" pos=".2 0 .01" euler=".1 .2 .3"/></body>)";
}

// Inertia, weight and spin forces, and where the tip is.
std::vector<double> Motion(const ModelAndData& machine) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  d.qpos[0] = 0.3, d.qpos[1] = -0.5, d.qvel[0] = 1, d.qvel[1] = 2;
  mj_forward(&m, &d);
  std::vector<double> all(m.nv * m.nv);
  mj_fullM(&m, &d, all.data());
  all.insert(all.end(), d.qfrc_bias, d.qfrc_bias + m.nv);
  all.insert(all.end(), d.sensordata, d.sensordata + m.nsensordata);
  return all;
}

std::vector<Change> Mounted(double roll, double pitch, double yaw) {
  return {{"body:two", "effect:mounting_angle.roll", roll},
          {"body:two", "effect:mounting_angle.pitch", pitch},
          {"body:two", "effect:mounting_angle.yaw", yaw}};
}

TEST(BodyTurn, ALinkMovesAsOneThatIsMountedSo) {
  const auto want =
      Motion(ModelSpec::Parse(Arm(Second(R"(pos=".2 0 0" euler=".1 -.2 .3")"))).Build());
  const ModelSpec straight = ModelSpec::Parse(Arm(Second(R"(pos=".2 0 0")"))),
                  framed = ModelSpec::Parse(Arm(R"(<frame pos=".1 .1 0" euler="0 0 1.2">)" +
                                                Second(R"(pos="-.056968133149055 -.12943968404439 0"
                                                          euler="0 0 -1.2")") +
                                                "</frame>"));
  EXPECT_THAT(Motion(straight.Build(Mounted(.1, -.2, .3))), Pointwise(DoubleNear(1e-12), want));
  EXPECT_THAT(Motion(framed.Build(Mounted(.1, -.2, .3))), Pointwise(DoubleNear(1e-9), want));
}

// A pendulum whose axis is tilted feels g cos(roll): I v²/2 = m g l cos(roll) (cos q − cos q_0).
TEST(BodyTurn, ATiltedPendulumSwingsUnderAShareOfItsWeight) {
  constexpr double kMass = 0.4, kArm = 0.3, kOwn = 0.01, kStart = 1.2;
  const ModelSpec upright = ModelSpec::Parse(R"(<mujoco><option timestep="1e-3" integrator="RK4"/>
      <worldbody><body name="two"><joint axis="0 1 0"/><inertial pos="0 0 -.3" mass=".4"
      diaginertia=".01 .01 .01"/></body></worldbody></mujoco>)");
  const ModelAndData machine = upright.Build(Mounted(0.5, 0, 0));
  mjData& d = *machine.data;
  d.qpos[0] = kStart;
  const double inertia = kOwn + kMass * kArm * kArm, weight = kMass * 9.81 * kArm * std::cos(0.5);
  for (int k = 0; k < 2000; ++k) {
    mj_step(machine.model.get(), &d);
    ASSERT_NEAR(0.5 * inertia * d.qvel[0] * d.qvel[0],
                weight * (std::cos(d.qpos[0]) - std::cos(kStart)), 1e-8);
  }
}

TEST(BodyTurn, TheJointStaysWhereItIs) {
  std::string xml = Arm(Second(R"(pos=".2 0 0" euler="0.4 0 0")"));
  xml.replace(xml.find("name=\"j\""), 8, "name=\"j\" pos=\".03 .02 .01\"");
  const ModelSpec arm = ModelSpec::Parse(xml);
  const auto anchor = [](const ModelAndData& machine) {
    mj_forward(machine.model.get(), machine.data.get());
    return std::vector<double>(machine.data->xanchor + 3, machine.data->xanchor + 6);
  };
  EXPECT_THAT(anchor(arm.Build(Mounted(.3, .5, -.4))),
              Pointwise(DoubleNear(1e-14), anchor(arm.Build())));
}

TEST(BodyTurn, LeavesNothingBehindAndIsInAnExtendedModel) {
  const ModelSpec arm = ModelSpec::Parse(Arm(Second(R"(pos=".2 0 0" euler="0.4 0 0")")));
  const std::string before = arm.Xml();
  const auto turned = Motion(arm.Build(Mounted(.1, .2, .3)));
  EXPECT_EQ(arm.Xml(), before);
  const auto extended = Motion(ModelSpec::Parse(arm.With(Mounted(.1, .2, .3), {}).Xml()).Build());
  EXPECT_THAT(extended, Pointwise(DoubleNear(1e-12), turned));
}

}  // namespace
}  // namespace continuum
