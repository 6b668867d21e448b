// Friction that depends on the load counts every force of the same evaluation.
#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kTauC = 0.1, kMuL = 0.2, kWeight = 9.81;

class Load : public testing::Engine {
 protected:
  static std::string Effect(const std::string& effect, const std::string& config) {
    return "<plugin plugin=\"continuum." + effect + "\"><instance name=\"" + effect + "\">" +
           config + "</instance></plugin>";
  }
  // A load of 1 kg on a cable around a corner of 45 degrees, with friction at the corner and on its
  // rail, which grows with what the rail transmits.
  static testing::Owned<mjModel> Hoist(bool rail_first) {
    const std::string corner = Effect("capstan", Key("tendon", "c") + Key("mu", "0.3")),
                      rail = Effect("load_friction",
                                    Key("joint", "z") + Key("tau_c", "0.1") + Key("mu_l", "0.2"));
    return Model(
        "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\"/><extension>" +
        (rail_first ? rail + corner : corner + rail) +
        R"(</extension><worldbody><site name="a" pos="0.1 0 .6"/><site name="b" pos="0 0 .5"/>
           <body><joint name="z" type="slide" axis="0 0 1"/>
           <inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/><site name="e"/></body></worldbody>
         <tendon><spatial name="c"><site site="a"/><site site="b"/><site site="e"/></spatial></tendon>
         <actuator><motor tendon="c" gear="-1"/></actuator></mujoco>)");
  }
};

TEST_F(Load, CountsTheCableFrictionOfThisEvaluation) {
  for (const bool rail_first : {true, false}) {
    const auto m = Hoist(rail_first);
    const auto d = Data(m);
    for (const double base : {10.0, 20.0, 3.0}) {
      d->ctrl[0] = base, d->qvel[0] = 0.1;
      const double corner = base * (std::exp(-0.3 * M_PI / 4) - 1);
      for (int k = 0; k < 3; ++k) {
        mj_forward(m.get(), d.get());
        EXPECT_NEAR(d->qfrc_passive[0], corner, 1e-9);
        EXPECT_NEAR(d->efc_frictionloss[0],
                    kTauC + kMuL * 0.5 * std::abs(base - (corner - kWeight)), 1e-9)
            << "base " << base << ", forward " << k;
      }
    }
  }
}

// An arm of 1 kg whose weight the joint leaves to its actuators (or not): the gear transmits half
// of what these give less what others do, which MuJoCo itself says.
TEST_F(Load, CountsTheWeightThatActuatorsCompensate) {
  for (const std::string by_actuators : {"false", "true"}) {
    const auto m =
        Model("<mujoco>" + Instance("load_friction", Key("joint", "j") + Key("mu_l", "0.2")) +
              R"(<worldbody><body gravcomp="1"><joint name="j" axis="0 1 0"
        actuatorfrcrange="-1.6 1.6" actuatorgravcomp=")" +
              by_actuators + R"("/><geom type="capsule" size=".02"
        fromto="0 0 0 .3 0 0" mass="1"/></body></worldbody>
      <actuator><motor joint="j"/></actuator></mujoco>)");
    const auto d = Data(m);
    for (const double u : {0., .5, -.5}) {
      d->ctrl[0] = u;
      mj_forward(m.get(), d.get());
      const double others = d->qfrc_passive[0] - d->qfrc_bias[0];
      EXPECT_NEAR(d->efc_frictionloss[0], kMuL * 0.5 * std::abs(d->qfrc_actuator[0] - others),
                  1e-12)
          << "by actuators " << by_actuators << ", u " << u;
    }
  }
}

TEST_F(Load, ReplaysBitByBitAndInvertsExactly) {
  const auto m = Hoist(false);
  const auto drive = [&](mjData* d) { d->ctrl[0] = 10 + 4 * std::sin(7 * d->time); };
  const auto d = Data(m), restored = Data(m), repeated = Data(m);
  for (int k = 0; k < 300; ++k) drive(d.get()), mj_step(m.get(), d.get());
  const auto saved = State(m, d);
  mj_setState(m.get(), restored.get(), saved.data(), mjSTATE_INTEGRATION);
  mj_copyData(repeated.get(), m.get(), d.get());
  for (int k = 0; k < 200; ++k) {
    for (mjData* const e : {d.get(), restored.get(), repeated.get()}) drive(e);
    mj_forward(m.get(), repeated.get());
    for (mjData* const e : {d.get(), restored.get(), repeated.get()}) mj_step(m.get(), e);
  }
  EXPECT_EQ(State(m, restored), State(m, d));
  EXPECT_EQ(State(m, repeated, mjSTATE_PHYSICS), State(m, d, mjSTATE_PHYSICS));
  for (int k = 0; k < 40; ++k) {
    drive(d.get());
    mj_step(m.get(), d.get());
    mj_forward(m.get(), d.get());
    mj_inverse(m.get(), d.get());
    EXPECT_NEAR(d->qfrc_inverse[0], d->qfrc_actuator[0], 1e-9);
  }
}

// The servo drives the wheel only beyond its free play: the gear carries kp (error − gap/2).
TEST_F(Load, CountsTheServoBehindItsBacklash) {
  for (const bool wheel_first : {true, false}) {
    const std::string play = Effect("backlash", Key("actuator", "a") + Key("gap", "0.1")),
                      wheel = Effect("load_friction",
                                     Key("joint", "j") + Key("tau_c", "0.1") + Key("mu_l", "0.2"));
    const auto m = Model("<mujoco><option gravity=\"0 0 0\"/><extension>" +
                         (wheel_first ? wheel + play : play + wheel) +
                         R"(</extension><worldbody><body><joint name="j" axis="0 1 0"/>
           <inertial pos="0 0 0" mass="1" diaginertia=".02 .02 .02"/></body></worldbody>
         <actuator><position name="a" joint="j" kp="10"/></actuator></mujoco>)");
    const auto d = Data(m);
    d->ctrl[0] = 0.5;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->efc_frictionloss[0], kTauC + kMuL * 0.5 * 10 * (0.5 - 0.05), 1e-12);
  }
}

}  // namespace
}  // namespace continuum
