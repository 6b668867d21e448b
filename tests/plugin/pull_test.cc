#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

class Pull : public testing::Engine {
 protected:
  // A mass on a rail at the end of a cable of 1 m, held by a spring; a servo winds the cable up.
  static std::string Winch(
      const std::string& effect, const std::string& config,
      const std::string& actuator = R"(<position tendon="cable" gear="-1" kp="400" kv="10"/>)") {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
           (effect.empty() ? "" : Instance(effect, Key("tendon", "cable") + config)) +
           R"(<worldbody><site name="a"/>
             <body pos="1 0 0"><joint name="x" type="slide" axis="1 0 0" stiffness="600" damping="20"/>
               <geom size=".05" mass="1"/><site name="b"/></body></worldbody>
             <tendon><spatial name="cable"><site site="a"/><site site="b"/></spatial></tendon>
             <actuator>)" +
           actuator + "</actuator></mujoco>";
  }
  // Where the mass rests when the servo wants the cable shorter by `wound`.
  static double RestAt(const std::string& xml, double wound) {
    const auto m = Model(xml);
    const auto d = Data(m);
    d->ctrl[0] = -(1 - wound);
    RunUntil(m, d, 5);
    return d->qpos[0];
  }
};

// Servo k, cable 1/c and spring s in series: s |x| = (wound − |x|) k/(1 + k c).
TEST_F(Pull, StretchIsASpringInSeriesWithTheServo) {
  const double k = 400 / (1 + 400 * 2e-3);
  EXPECT_NEAR(RestAt(Winch("tendon_stretch", Key("compliance", "2e-3")), 0.05),
              -0.05 * k / (k + 600), 1e-9);
}

TEST_F(Pull, SlackIsWoundUpFirst) {
  const std::string xml = Winch("slack", Key("length", "0.02"));
  EXPECT_NEAR(RestAt(xml, 0.015), 0, 1e-12);
  EXPECT_NEAR(RestAt(xml, 0.05), -0.03 * 400 / (400 + 600), 1e-9);
}

TEST_F(Pull, SlackAndStretchActTogetherInAnyOrder) {
  const std::string stretch = "<plugin plugin=\"continuum.tendon_stretch\"><instance name=\"s\">" +
                              Key("tendon", "cable") + Key("compliance", "2e-3") +
                              "</instance></plugin>";
  const double k = 400 / (1 + 400 * 2e-3);
  for (const char* before : {"<plugin", "</extension>"}) {
    std::string xml = Winch("slack", Key("length", "0.02"));
    xml.insert(xml.find(before), stretch);
    EXPECT_NEAR(RestAt(xml, 0.05), -0.03 * k / (k + 600), 1e-9);
  }
}

// The friction of the rail follows the tension that the slack leaves.
TEST_F(Pull, LawsOfForcesSeeWhatSignalsMakeOfThem) {
  const std::string friction = "<plugin plugin=\"continuum.load_friction\"><instance name=\"f\">" +
                               Key("joint", "x") + Key("tau_c", "0") + Key("mu_l", "0.1") +
                               Key("load", "actuator") + "</instance></plugin>";
  for (const char* before : {"<plugin", "</extension>"}) {
    std::string xml = Winch("slack", Key("length", "0.02"));
    xml.insert(xml.find(before), friction);
    const auto m = Model(xml);
    const auto d = Data(m);
    d->ctrl[0] = -(1 - 0.05);
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->efc_frictionloss[0], 0.1 * 400 * 0.03, 1e-12);
  }
}

TEST_F(Pull, TheGearMayWindEitherWay) {
  const std::string xml = Winch("slack", Key("length", "0.02"),
                                R"(<position tendon="cable" gear="2" kp="100" kv="2"/>)");
  const auto m = Model(xml);
  const auto d = Data(m);
  d->ctrl[0] = 2 * 0.95;
  RunUntil(m, d, 5);
  EXPECT_NEAR(d->qpos[0], -0.03 * 400 / (400 + 600), 1e-9);
}

TEST_F(Pull, AtTheirNullTheyAreExactlyTheNativeModel) {
  for (const auto& [effect, key] :
       {std::pair{"slack", "length"}, {"tendon_stretch", "compliance"}}) {
    const auto m = Model(Winch(effect, Key(key, "0"))), native = Model(Winch("", ""));
    const auto d = Data(m), e = Data(native);
    for (int k = 0; k < 500; ++k) {
      d->ctrl[0] = e->ctrl[0] = -1 + 0.05 * std::sin(0.02 * k);
      mj_step(m.get(), d.get()), mj_step(native.get(), e.get());
      ASSERT_EQ(d->qpos[0], e->qpos[0]);
    }
  }
}

TEST_F(Pull, WarnsWhereAGivenForceMakesThemSilent) {
  static std::string warning;
  mju_user_warning = [](const char* text) { warning = text; };
  std::string xml = Winch("slack", "", "<motor tendon=\"cable\" gear=\"-1\"/>");
  xml.replace(xml.find("name=\"i\""), 8, "name=\"silent\"");  // warnings come once for a name
  Data(Model(xml));
  EXPECT_THAT(warning, HasSubstr("tendon 'cable' is not pulled by a position servo"));
  mju_user_warning = [](const char*) {};
}

}  // namespace
}  // namespace continuum
