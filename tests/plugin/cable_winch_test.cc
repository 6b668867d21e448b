// A cable over a corner that a motor with inertia speeds up.
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty;

constexpr double kMu = 0.3, kPull = 10;

class CableWinch : public testing::Engine {
 protected:
  struct Winch {
    std::string end = R"(<site name="end" pos="-.5 0 1"/>)", tendon = {}, drum = {}, equality = {},
                motor = R"(<motor joint="w"/>)", name = "t";
  };
  // The load is 1 kg.
  static std::string Xml(const Winch& winch) {
    return "<mujoco>" +
           Instance("capstan", Key("tendon", winch.name) + Key("mu", std::to_string(kMu))) +
           fmt::format(R"(<option timestep="5e-4" integrator="implicitfast" gravity="0 0 0"/>
      <worldbody>{}<site name="corner" pos="0 0 1"/>
        <body pos="0 0 .5"><joint name="z" type="slide" axis="0 0 1"/>
          <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><site name="load"/></body></worldbody>
      <tendon><spatial name="{}" {}><site site="end"/><site site="corner"/><site site="load"/></spatial>
        {}</tendon><equality>{}</equality><actuator>{}</actuator></mujoco>)",
                       winch.end, winch.name, winch.tendon, winch.drum, winch.equality,
                       winch.motor);
  }
};

// The rotor takes I a of the motor's force, and the corner its share of what is left:
// u = I a + m a e^(μθ).
TEST_F(CableWinch, ARotorOfItsOwnTakesItsShareBeforeTheCornerDoes) {
  for (const double inertia : {.1, 1., 10.}) {
    const std::string rotor = fmt::format(R"(<joint name="w" type="slide" axis="-1 0 0"/>
        <inertial pos="0 0 0" mass="{}" diaginertia="1 1 1"/>)",
                                          inertia);
    const Winch by_limit{"<body pos='-.5 0 1'>" + rotor + R"(<site name="end"/></body>)",
                         R"(limited="true" range="0 1" solreflimit=".003 1")"};
    const Winch by_equality{
        R"(<site name="end" pos="-.5 0 1"/><body pos="-3 0 0">)" + rotor + "</body>", "",
        R"(<fixed name="drum"><joint joint="w" coef="1"/></fixed>)",
        R"(<tendon tendon1="t" tendon2="drum" polycoef="0 -1" solref=".003 1"/>)"};
    for (const Winch& winch : {by_limit, by_equality}) {
      const auto m = Model(Xml(winch));
      const auto d = Data(m);
      const int load = m->jnt_dofadr[mj_name2id(m.get(), mjOBJ_JOINT, "z")];
      d->ctrl[0] = kPull;
      RunUntil(m, d, .1);
      const double speed = d->qvel[load];
      RunUntil(m, d, .2);
      const double expected = kPull / (inertia + std::exp(kMu * mjPI / 2));
      EXPECT_NEAR((d->qvel[load] - speed) / .1, expected, 1e-8) << "rotor of " << inertia;
    }
  }
}

std::vector<std::string> warnings;

// Armature of a tendon and of its actuators is no part of the tension (docs/cables.md).
TEST_F(CableWinch, AWarningNamesCablesWithArmature) {
  const auto warnings_of = [](const std::string& name, const std::string& tendon,
                              const std::string& actuator) {
    Winch winch;
    winch.name = name, winch.tendon = tendon;
    winch.motor = fmt::format(R"(<motor tendon="{}" gear="-1" {}/>)", name, actuator);
    warnings.clear();
    mju_user_warning = [](const char* text) { warnings.emplace_back(text); };
    const auto m = Model(Xml(winch));
    mju_user_warning = [](const char*) {};
    return warnings;
  };
  EXPECT_THAT(warnings_of("light", "", ""), IsEmpty());
  EXPECT_THAT(warnings_of("drum", R"(armature="1")", ""), ElementsAre(HasSubstr("on 'drum'")));
  EXPECT_THAT(warnings_of("motor", "", R"(armature="1")"), ElementsAre(HasSubstr("on 'motor'")));
}

}  // namespace
}  // namespace continuum
