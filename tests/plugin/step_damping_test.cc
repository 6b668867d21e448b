// The damping that is taken implicitly in a step, against what MuJoCo's integrators do.
#include "binding/step_damping.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kStep = 0.01, kSpeed = 0.7;

class StepDampingTest : public testing::Engine {
 protected:
  struct Rig {
    std::string actuator, joint = {}, tendon = {}, option = {}, flag = {};
    std::vector<double> control = {0.5, 0.5, 0.5};
  };
  // 1 kg on a rail, and a tendon along it.
  static std::string Xml(const Rig& rig, const std::string& integrator) {
    return fmt::format(R"(<mujoco><option timestep="{}" integrator="{}" {}>{}</option><worldbody>
        <body><joint name="j" type="slide" {}/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody>
      <tendon><fixed name="t" {}><joint joint="j" coef="2"/></fixed></tendon>
      <actuator>{}</actuator></mujoco>)",
                       kStep, integrator, rig.option, rig.flag, rig.joint, rig.tendon,
                       rig.actuator);
  }
  // What a step shows, (M + h D) Δv = h F, less what StepDamping says [N s/m].
  static double Error(const Rig& rig, const std::string& integrator) {
    const auto m = Model(Xml(rig, integrator));
    const auto d = Data(m);
    d->qvel[0] = kSpeed;
    for (int u = 0; u < m->nu; ++u) d->ctrl[u] = rig.control[u];
    for (int a = 0; a < m->na; ++a) d->act[a] = 0.4;
    d->qfrc_applied[0] = 3;
    mj_forward(m.get(), d.get());
    StepDamping damping;
    damping.Update(*m, *d);
    const double force = d->qfrc_smooth[0], said = damping.joint[0] / kStep;
    mj_step(m.get(), d.get());
    return said - (kStep * force / (d->qvel[0] - kSpeed) - 1) / kStep;
  }
};

TEST_F(StepDampingTest, IsThatOfTheIntegrator) {
  const std::string servo = R"(<position joint="j" kp="10" kv="3" gear="2"/>)";
  const std::string damper = R"(<damper joint="j" kv="3" ctrlrange="0 10"/>)";
  const std::string affine = R"(<general joint="j" gaintype="affine" gainprm="1 0 -3" )";
  const std::string free = R"(<dcmotor joint="j" motorconst="0 0" resistance="1" input="none"/>)";
  const std::vector<std::pair<std::string, Rig>> rigs{
      {"joint", {"", R"(damping="3 1 0.5")"}},
      {"tendon", {"", "", R"(damping="3 1 0.5")"}},
      {"damping of an actuator on the joint", {R"(<motor joint="j" gear="2" damping="3 1 0.5"/>)"}},
      {"damping of an actuator on the tendon",
       {R"(<motor tendon="t" gear="2" damping="3 1 0.5"/>)"}},
      {"two actuators on the tendon",
       {R"(<motor tendon="t" damping="3"/><motor tendon="t" damping="0 2"/>)", "",
        R"(damping="1")"}},
      {"no dampers",
       {R"(<motor joint="j" damping="2"/>)", R"(damping="3")", R"(damping="3")", "",
        R"(<flag damper="disable"/>)"}},
      {"servo", {servo}},
      {"servo beyond its range", {R"(<position joint="j" kp="10" kv="3" forcerange="-.1 .1"/>)"}},
      {"servo beyond the range of the joint", {servo, R"(actuatorfrcrange="-.1 .1")"}},
      {"servo beside a motor beyond the range of the joint",
       {R"(<motor joint="j" gear="5"/>)" + servo, R"(actuatorfrcrange="-.1 .1")"}},
      {"servo of a group that is off",
       {R"(<position joint="j" kp="10" kv="3" group="1"/>)", "", "",
        R"(actuatorgroupdisable="1")"}},
      {"actuation off", {servo, "", "", "", R"(<flag actuation="disable"/>)"}},
      {"damper", {damper}},
      {"damper beyond its control range", {.actuator = damper, .control = {20}}},
      {"damper whose control is not clamped",
       {.actuator = damper, .flag = R"(<flag clampctrl="disable"/>)", .control = {20}}},
      {"damper behind an actuator without control", {.actuator = free + damper, .control = {2}}},
      {"damper behind one with two",
       {.actuator = R"(<pid joint="j" input="pos vel" kp="0"/>)" + damper, .control = {0, 0, 2}}},
      {"activation", {affine + R"(dyntype="integrator"/>)"}},
      {"activation of the step's end",
       {affine + R"(dyntype="filter" dynprm="0.1" actearly="true"/>)"}},
  };
  for (const std::string integrator : {"Euler", "implicitfast", "implicit"}) {
    for (const auto& [name, rig] : rigs)
      EXPECT_NEAR(Error(rig, integrator), 0, 1e-9) << name << ", " << integrator;
  }
}

// A cable that rests while its load goes up and down by 4 %, within the band. What the integrator
// does not take must not be counted: 2 kN s/m too much would throw a load of 0.2 kg back by five
// times its speed in each step.
TEST_F(StepDampingTest, WhatIsOffLeavesACableAtRest) {
  const auto fastest = [](const std::string& option, const std::string& tendon,
                          const std::string& more, double control) {
    const auto m = Model(
        "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" "
        "gravity=\"0 0 0\" " +
        option + "/>" + Instance("capstan", Key("tendon", "cable") + Key("mu", "0.15")) +
        R"(<worldbody><site name="winch" pos="-1 0 1"/><site name="corner" pos="0 0 1"/>
        <body><joint name="rail" type="slide" axis="0 0 1"/>
          <inertial pos="0 0 0" mass="0.2" diaginertia="1 1 1"/><site name="load"/></body></worldbody>
        <tendon><spatial name="cable"><site site="winch"/><site site="corner"/><site site="load"/>
          </spatial><fixed name="rail" )" +
        tendon + R"(><joint joint="rail" coef="1"/></fixed></tendon>
        <actuator><motor tendon="cable" gear="-1"/>)" +
        more + "</actuator></mujoco>");
    const auto d = Data(m);
    double speed = 0;
    for (int k = 0; k < 300; ++k) {
      d->ctrl[0] = 10, d->qfrc_applied[0] = k % 2 ? -10.1 : -10.5;
      for (int u = 1; u < m->nu; ++u) d->ctrl[u] = control;
      mj_step(m.get(), d.get());
      if (k > 100) speed = std::max(speed, std::abs(d->qvel[0]));
    }
    return speed;
  };
  const double alone = fastest("", "", "", 0);
  EXPECT_LT(alone, 2e-4);
  const std::string servo = R"(<position joint="rail" kp="0" kv="2000" group="1"/>)";
  EXPECT_EQ(fastest(R"(actuatorgroupdisable="1")", "", servo, 0), alone) << "group off";
  const std::string damper = R"(<damper joint="rail" kv="2000" ctrlrange="0 0.001"/>)";
  EXPECT_LT(fastest("", "", damper, 1), 2 * alone) << "beyond its control range";
  const std::string pushed = R"(<general tendon="rail" biastype="affine" biasprm="1 0 -2000"/>)";
  EXPECT_LT(fastest("", R"(actuatorfrcrange="-.1 .1")", pushed, 0), 2 * alone) << "tendon range";
}

}  // namespace
}  // namespace continuum
