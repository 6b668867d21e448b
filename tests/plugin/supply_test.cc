#include <cmath>
#include <string>
#include <vector>

#include "support/engine.h"

namespace continuum {
namespace {

class Supply : public testing::Engine {
 protected:
  static constexpr double kR = 0.2;  // 1/N

  // Three masses of 1 kg on rails of their own, each with an actuator.
  static std::string Rails(const std::string& effects, const std::string& more = "") {
    std::string bodies;
    for (const std::string name : {"a", "b", "c"}) {
      bodies += "<body><joint name=\"" + name +
                "\" type=\"slide\" axis=\"1 0 0\"/><geom size=\".1\" " +
                "mass=\"1\" contype=\"0\" conaffinity=\"0\"/></body>";
    }
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
           effects + "<worldbody>" + bodies +
           "</worldbody><actuator><motor name=\"a\" joint=\"a\" " + "gear=\"2\" " + more +
           "/><position name=\"b\" joint=\"b\" kp=\"50\" kv=\"3\" " +
           "forcerange=\"-4 4\"/><motor name=\"c\" joint=\"c\"/></actuator></mujoco>";
  }
  static std::string Sag(const std::string& actuators, const std::string& r = "0.2") {
    return Instance("supply_sag", Key("actuator", actuators) + Key("r", r));
  }
  // Accelerations at rest under some controls [m/s²], of masses of 1 kg.
  static std::vector<double> Accelerations(const std::string& xml, std::vector<double> ctrl) {
    const auto m = Model(xml);
    const auto d = Data(m);
    std::copy(ctrl.begin(), ctrl.end(), d->ctrl);
    mj_forward(m.get(), d.get());
    return {d->qacc, d->qacc + 3};
  }
};

TEST_F(Supply, EachGivesLessWhereAnyDraws) {
  const auto a = Accelerations(Rails(Sag("a b")), {1.5, -0.02, 7});
  const double share = 1 / (1 + kR * (1.5 + 1));
  EXPECT_NEAR(a[0], 2 * 1.5 * share, 1e-12);  // a gear of 2
  EXPECT_NEAR(a[1], -1 * share, 1e-12);
  EXPECT_NEAR(a[2], 7, 1e-12);  // on a supply of its own
}

TEST_F(Supply, DrawsWhatTheRangesLeave) {
  const auto a = Accelerations(Rails(Sag("a b")), {1.5, 3, 0});
  const double share = 1 / (1 + kR * (1.5 + 4));
  EXPECT_NEAR(a[0], 2 * 1.5 * share, 1e-12);
  EXPECT_NEAR(a[1], 4 * share, 1e-12);
}

TEST_F(Supply, TwoSuppliesAreApart) {
  const std::string second = Instance("supply_sag", Key("actuator", "c") + Key("r", "1"));
  std::string both = Sag("a b") + second;
  both.replace(both.rfind("name=\"i\""), 8, "name=\"j\"");
  const auto a = Accelerations(Rails(both), {1.5, -0.02, 7});
  EXPECT_NEAR(a[1], -1 / (1 + kR * 2.5), 1e-12);
  EXPECT_NEAR(a[2], 7 / (1 + 7.0), 1e-12);
}

// Whatever the order of the instances: play in the servo is taken up before anything is drawn.
TEST_F(Supply, ActsOnWhatOtherSignalsLeave) {
  const std::string gap = "<plugin plugin=\"continuum.backlash\"><instance name=\"p\">" +
                          Key("actuator", "b") + Key("gap", ".02") + "</instance></plugin>";
  for (const char* const before : {"<plugin", "</extension>"}) {
    std::string effects = Sag("a b");
    effects.insert(effects.find(before), gap);
    const auto a = Accelerations(Rails(effects), {1.5, -0.02, 0});
    EXPECT_NEAR(a[1], -0.5 / (1 + kR * (1.5 + 0.5)), 1e-12);
  }
}

TEST_F(Supply, WithoutResistanceIsExactlyTheNativeModel) {
  const auto m = Model(Rails(Sag("*", "0"))), native = Model(Rails(""));
  const auto d = Data(m), e = Data(native);
  for (int k = 0; k < 500; ++k) {
    for (int i = 0; i < 3; ++i) d->ctrl[i] = e->ctrl[i] = std::sin(0.02 * k * (i + 1));
    mj_step(m.get(), d.get()), mj_step(native.get(), e.get());
    for (int i = 0; i < 3; ++i) ASSERT_EQ(d->qpos[i], e->qpos[i]);
  }
}

// u/(1 + r u) = τ_c: a stiff supply would overcome this friction at u = τ_c.
TEST_F(Supply, BreaksAwayWhereWhatItLeavesExceedsTheFriction) {
  constexpr double kFriction = 2, kControl = kFriction / (1 - kR * kFriction);
  std::string rub = Instance("coulomb", Key("joint", "c") + Key("tau_c", "2"));
  rub.replace(rub.find("name=\"i\""), 8, "name=\"f\"");
  const auto m = Model(Rails(Sag("c") + rub));
  for (const double share : {0.99, 1.01}) {
    const auto d = Data(m);
    d->ctrl[2] = share * kControl;
    RunUntil(m, d, 1);
    const double left = d->ctrl[2] / (1 + kR * d->ctrl[2]) - kFriction;
    EXPECT_NEAR(d->qvel[2], std::max(0.0, left), 1e-4) << share;
    const double speed = d->qvel[2];
    RunUntil(m, d, 2);
    EXPECT_NEAR(d->qvel[2], share < 1 ? 0 : 2 * speed, 1e-4) << share;
  }
}

// A mass that is pushed for a while: m v = u t/(1 + r u).
TEST_F(Supply, SlowsWhatItDrives) {
  const auto m = Model(Rails(Sag("c")));
  const auto d = Data(m);
  d->ctrl[2] = 6;
  RunUntil(m, d, 1);
  EXPECT_NEAR(d->qvel[2], 6 / (1 + kR * 6), 1e-10);
}

}  // namespace
}  // namespace continuum
