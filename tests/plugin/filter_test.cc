#include <cmath>
#include <string>

#include "effects/pt2.h"
#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Filter : public testing::Engine {
 protected:
  static std::string Slide(const std::string& actuator, const std::string& w = "30") {
    return "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
           (w.empty() ? ""
                      : Instance("pt2", Key("actuator", "u") + Key("w", w) + Key("zeta", ".4"))) +
           R"(<worldbody><body><joint name="x" type="slide" axis="1 0 0"/>
              <geom size=".1" mass="1"/></body></worldbody><actuator>)" +
           actuator + "</actuator></mujoco>";
  }
  // y of the law under the controls that a test gave, one per step.
  struct Law {
    Vec<double, 2> z{0, 0};
    void Step(double u) { z = Pt2::Step<double>(z, u, 2e-3, {30, 0.4}); }
  };
};

TEST_F(Filter, AMotorReceivesTheLaggedControl) {
  const auto m = Model(Slide("<motor name=\"u\" joint=\"x\" gear=\"1\" ctrlrange=\"-1 1\"/>"));
  const auto d = Data(m);
  Law law;
  for (int k = 0; k < 500; ++k) {
    d->ctrl[0] = k < 100 ? 0.7 : 3;  // clamped to 1
    mj_step(m.get(), d.get());
    EXPECT_NEAR(d->actuator_force[0], law.z[0], 1e-15);
    law.Step(k < 100 ? 0.7 : 1);
  }
}

TEST_F(Filter, APositionServoFollowsTheLaggedControl) {
  const auto m = Model(Slide("<position name=\"u\" joint=\"x\" kp=\"50\" kv=\"5\"/>"));
  const auto d = Data(m);
  Law law;
  for (int k = 0; k < 300; ++k) {
    d->ctrl[0] = 0.1;
    const double x = d->qpos[0], v = d->qvel[0];
    mj_step(m.get(), d.get());
    EXPECT_NEAR(d->actuator_force[0], 50 * (law.z[0] - x) - 5 * v, 1e-12);
    law.Step(0.1);
  }
}

TEST_F(Filter, ComesBeforeALagOfTheActuator) {
  const double T = 0.05;
  const auto m = Model(Slide(
      "<general name=\"u\" joint=\"x\" dyntype=\"filterexact\" dynprm=\"0.05\" gainprm=\"2\"/>"));
  const auto d = Data(m);
  Law law;
  double act = 0;
  for (int k = 0; k < 500; ++k) {
    d->ctrl[0] = 1;
    mj_step(m.get(), d.get());
    EXPECT_NEAR(d->actuator_force[0], 2 * act, 1e-12);
    act += (law.z[0] - act) * (1 - std::exp(-2e-3 / T));
    law.Step(1);
  }
}

TEST_F(Filter, ComesAfterADeadTime) {
  const auto m = Model(Slide("<motor name=\"u\" joint=\"x\" delay=\"0.02\" nsample=\"40\"/>"));
  const auto d = Data(m);
  Law law;
  for (int k = 0; k < 200; ++k) {
    d->ctrl[0] = 1;
    mj_step(m.get(), d.get());
    EXPECT_NEAR(d->actuator_force[0], law.z[0], 1e-12) << k;
    law.Step(k < 10 ? 0 : 1);
  }
}

TEST_F(Filter, WithoutLagIsExactlyTheNativeModel) {
  const std::string servo = "<position name=\"u\" joint=\"x\" kp=\"50\" kv=\"5\"/>";
  const auto m = Model(Slide(servo, "inf")), native = Model(Slide(servo, ""));
  const auto d = Data(m), e = Data(native);
  for (int k = 0; k < 300; ++k) {
    d->ctrl[0] = e->ctrl[0] = std::sin(0.05 * k);
    mj_step(m.get(), d.get()), mj_step(native.get(), e.get());
    ASSERT_EQ(d->qpos[0], e->qpos[0]);
  }
}

TEST_F(Filter, NamesActuatorsThatItCannotLag) {
  EXPECT_THAT(Compile(Slide("<muscle name=\"u\" joint=\"x\" lengthrange=\"0 1\"/>")).error,
              AllOf(HasSubstr("actuator 'u': expected one control with a fixed gain"),
                    HasSubstr("found gaintype=\"muscle\" biastype=\"muscle\" dyntype=\"muscle\"")));
}

}  // namespace
}  // namespace continuum
