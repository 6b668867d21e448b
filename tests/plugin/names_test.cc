// How an instance names the objects that it acts on, whatever characters their names have.
#include <cmath>

#include <fmt/format.h>

#include "binding/config.h"
#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Names : public testing::Engine {
 protected:
  // Dry friction on the joints of a key, of these two joints; returns their levels, or the error.
  static std::string On(const std::string& key, const std::string& a, const std::string& b) {
    const std::string config =
        fmt::format(R"(<config key="joint" value="{}"/><config key="tau_c" value="1"/>)", key);
    const auto joint = [](const std::string& name) {
      return fmt::format(R"(<body><joint axis="0 1 0" {}/><geom size=".1" pos=".1 0 0"/></body>)",
                         name.empty() ? "" : "name=\"" + name + "\"");
    };
    const auto [m, error] = Compile("<mujoco>" + Instance("coulomb", config) + "<worldbody>" +
                                    joint(a) + joint(b) + "</worldbody></mujoco>");
    if (!m) return error;
    std::string on;
    for (int i = 0; i < 2; ++i) on += m->dof_frictionloss[i] > 0 ? "1" : "0";
    return on;
  }
};

TEST_F(Names, AreTakenAsTheyAreWhereTheyAreTheWholeKey) {
  for (const std::string name : {"2nd Joint", "joint[0]", "*", "what?", "back\\slash", "[", "a b "})
    EXPECT_EQ(On(name, name, "other"), "10") << name;
  EXPECT_EQ(On("joint[0]", "joint0", "joint[0]"), "01");
}

TEST_F(Names, AreGlobsWhereTheyAreNone) {
  EXPECT_EQ(On("joint[0]", "joint0", "joint1"), "10");
  EXPECT_EQ(On("joint?", "joint0", "joint1"), "11");
  EXPECT_EQ(On("joint0 joint1", "joint0", "joint1"), "11");
}

TEST_F(Names, OfAListHaveABackslashBeforeASpaceAndBeforeCharactersOfAGlob) {
  EXPECT_EQ(On(R"(2nd\ Joint a)", "2nd Joint", "a"), "11");
  EXPECT_EQ(On(R"(joint\[0] a*)", "joint[0]", "ab"), "11");
  EXPECT_EQ(On(R"(\*)", "x", "*"), "01");
}

TEST_F(Names, ThatAreNotFoundAreFollowedByWhatToWrite) {
  EXPECT_THAT(On("2nd Join", "2nd Joint", "a"),
              HasSubstr(R"(no joint '2nd' in the model; a space in a name is written '\ ')"));
  EXPECT_THAT(On("*", "", ""), HasSubstr("no joint '*' in the model; give it a name"));
}

// A robot with a floating base: a free joint, a ball, a hinge and a slide.
class Globs : public testing::Engine {
 protected:
  static std::string Robot(const std::string& effect, const std::string& config) {
    return "<mujoco>" + Instance(effect, config) + R"(<worldbody><body pos="0 0 1">
      <freejoint name="root"/><geom size=".1"/><body pos=".2 0 0"><joint name="ball" type="ball"/>
      <geom size=".05"/><body pos=".2 0 0"><joint name="hinge" axis="0 1 0"/><geom size=".05"/>
      <body pos=".2 0 0"><joint name="slide" type="slide"/><geom size=".05"/></body></body></body>
      </body></worldbody><actuator><position name="servo" joint="hinge" kp="1"/>
      <motor name="motor" joint="slide"/><muscle name="power" joint="slide" lengthrange="0 1"/></actuator></mujoco>)";
  }
  // What is said as it compiles; the model too.
  static std::string Warnings(const std::string& effect, const std::string& config,
                              testing::Owned<mjModel>* model = nullptr) {
    static std::string warnings;
    warnings.clear();
    mju_user_warning = [](const char* text) { warnings += text; };
    auto [m, error] = Compile(Robot(effect, config));
    mju_user_warning = [](const char*) {};
    if (model) *model = std::move(m);
    return warnings + error;
  }
};

TEST_F(Globs, TakeTheJointsThatTheEffectActsOnAndNameTheOthers) {
  testing::Owned<mjModel> m;
  EXPECT_THAT(Warnings("coulomb", Key("joint", "*") + Key("tau_c", ".1"), &m),
              HasSubstr("continuum.coulomb 'i': it leaves out joints 'root' (a free joint)"));
  ASSERT_TRUE(m);
  const auto d = Data(m);
  mj_forward(m.get(), d.get());
  ASSERT_EQ(d->nf, 5);  // three of the ball, hinge and slide
  for (int r = 0; r < 5; ++r) EXPECT_EQ(d->efc_id[d->ne + r], 6 + r);
  EXPECT_THAT(Warnings("dahl", Key("joint", "*") + Key("f", ".1") + Key("sigma", "1"), &m),
              HasSubstr("it leaves out joints 'root' (a free joint), 'ball' (a ball joint)"));
  ASSERT_TRUE(m);
  EXPECT_EQ(m->npluginstate, 2);
  EXPECT_EQ(Warnings("dahl", Key("joint", "h* slide") + Key("f", ".1") + Key("sigma", "1")), "");
}

TEST_F(Globs, RefuseWhatIsWrittenByItsNameAndWhereNothingIsLeft) {
  const std::string friction = Key("tau_c", ".1");
  for (const std::string joint : {"root", "* root", "root hinge", "ro*", "[r]oot"})
    EXPECT_THAT(
        Warnings("coulomb", Key("joint", joint) + friction),
        HasSubstr("joint 'root': expected a hinge, slide or ball joint, found a free joint"))
        << joint;
}

TEST_F(Globs, TakeTheActuatorsThatTheEffectActsOnAndNameTheOthers) {
  testing::Owned<mjModel> m;
  EXPECT_THAT(Warnings("backlash", Key("actuator", "*") + Key("gap", ".1"), &m),
              HasSubstr("it leaves out actuators 'motor' ("));
  EXPECT_TRUE(m);
  EXPECT_THAT(Warnings("pt2", Key("actuator", "*") + Key("w", "30"), &m),
              HasSubstr("it leaves out actuators 'power' ("));
  ASSERT_TRUE(m);
  const auto d = Data(m);
  for (int k = 0; k < 20; ++k) mj_step(m.get(), d.get());
  EXPECT_TRUE(std::isfinite(d->qpos[0]));
  EXPECT_THAT(Warnings("backlash", Key("actuator", "motor servo") + Key("gap", ".1")),
              HasSubstr("actuator 'motor': expected a position servo"));
}

TEST_F(Names, ThatAreEscapedMatchThemselvesAlone) {
  const std::vector<std::string> names{"a", "a b", "a*", "a[0]", "a0", "a?", "\\a", "a\\", " "};
  for (const std::string& name : names) {
    EXPECT_THAT(Words("x " + Escaped(name)), ElementsAre("x", Escaped(name)));
    EXPECT_EQ(Unescaped(Escaped(name)), name);
    for (const std::string& other : names)
      EXPECT_EQ(AnyGlobMatches(Escaped(name), other), name == other) << name << " " << other;
  }
}

}  // namespace
}  // namespace continuum
