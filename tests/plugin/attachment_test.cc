// Effects of robots that attach has put into a scene, whatever it puts around their names.

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using Levels = std::vector<double>;  // of the friction rows, in the order of the joints

// Two dry joints, "bend1" and "bend2", of 0.05 N m.
std::string Arm(const std::string& joints) {
  return R"(<mujoco model="arm"><extension><plugin plugin="continuum.coulomb"><instance name="fr">
    <config key="joint" value=")" +
         joints + R"("/><config key="tau_c" value=".05"/></instance></plugin></extension><worldbody>
    <body name="base"><plugin plugin="continuum.coulomb" instance="fr"/>
      <joint name="bend1" axis="0 1 0"/><geom size=".02" pos="0 0 -.3"/>
      <body name="tip" pos="0 0 -.3"><joint name="bend2" axis="0 1 0"/><geom size=".02" pos="0 0 -.3"/>
    </body></body></worldbody></mujoco>)";
}

struct Around {
  std::string prefix, suffix;
};

class Attachments : public testing::Engine {
 protected:
  // Arms attached to the world, or to a body of the scene; what acts on each joint of all.
  static Levels In(const std::string& scene, const std::string& joints,
                   const std::vector<Around>& arms, const std::string& at = "world") {
    char error[1000] = "";
    const testing::Owned<mjSpec> parent(
        mj_parseXMLString(scene.c_str(), nullptr, error, sizeof error));
    EXPECT_TRUE(parent) << error;
    std::vector<testing::Owned<mjSpec>> children;
    for (const auto& [prefix, suffix] : arms) {
      children.emplace_back(mj_parseXMLString(Arm(joints).c_str(), nullptr, error, sizeof error));
      mjsFrame* const frame = mjs_addFrame(mjs_findBody(parent.get(), at.c_str()), nullptr);
      const mjsBody* const base = mjs_findBody(children.back().get(), "base");
      EXPECT_TRUE(mjs_attach(frame->element, base->element, prefix.c_str(), suffix.c_str()));
    }
    const testing::Owned<mjModel> m(mj_compile(parent.get(), nullptr));
    EXPECT_TRUE(m) << mjs_getError(parent.get());
    if (!m) return {};
    const auto d = Data(m);
    mj_forward(m.get(), d.get());
    Levels levels(m->njnt);
    for (int r = d->ne; r < d->ne + d->nf; ++r) levels[d->efc_id[r]] = d->efc_frictionloss[r];
    return levels;
  }

  static constexpr const char* kEmpty = "<mujoco/>";
  // A robot of the scene's own, with a joint of the same name, and no friction.
  static constexpr const char* kOwn = R"(<mujoco><worldbody><body name="wrist" pos="0 3 0">
      <joint name="bend1" axis="0 1 0"/><geom size=".1"/></body></worldbody></mujoco>)";
};

TEST_F(Attachments, KeepTheirFrictionWithAndWithoutASeparator) {
  for (const std::string joints : {"bend*", "bend1 bend2", "bend[12]", "*"}) {
    for (const std::string prefix : {"a", "a/", "a_", "fr", "arm 1 "}) {
      EXPECT_EQ(In(kEmpty, joints, {{prefix, ""}}), (Levels{.05, .05})) << joints << prefix;
      EXPECT_EQ(In(kOwn, joints, {{prefix, ""}}), (Levels{0, .05, .05})) << joints << prefix;
    }
  }
}

TEST_F(Attachments, DoNotActOnEachOther) {
  using Names = std::vector<Around>;
  const Levels right{0, .05, .05, .05, .05};
  for (const std::string joints : {"bend*", "bend1 bend2", "*"}) {
    for (const Names& names :
         {Names{{"left", ""}, {"right", ""}}, {{"r1", ""}, {"r11", ""}}, {{"x", ""}, {"xy", ""}}})
      EXPECT_EQ(In(kOwn, joints, names), right) << joints << names[0].prefix;
    for (const Names& names : {Names{{"", "left"}, {"", "right"}}, {{"", "1"}, {"", "11"}}})
      EXPECT_EQ(In(kOwn, joints, names), right) << joints << names[0].suffix;
    const Names both{{"q", "left"}, {"q", "right"}};
    EXPECT_EQ(In(kOwn, joints, both), right) << joints;
  }
}

// A model of two fingers side by side, of which one refers to the instance.
TEST_F(Attachments, OfSeveralBranchesAreOneRobot) {
  const std::string hand = R"(<mujoco model="hand"><extension><plugin plugin="continuum.coulomb">
    <instance name="fr"><config key="joint" value="*bend"/><config key="tau_c" value=".05"/></instance>
    </plugin></extension><worldbody>
    <body name="thumb"><plugin plugin="continuum.coulomb" instance="fr"/>
      <joint name="tbend"/><geom size=".02" pos="0 0 -.3"/></body>
    <body name="index"><joint name="ibend"/><geom size=".02" pos="0 0 -.3"/></body>
    </worldbody></mujoco>)";
  char error[1000] = "";
  const testing::Owned<mjSpec> scene(mj_makeSpec());
  std::vector<testing::Owned<mjSpec>> hands;
  for (const char* const prefix : {"h1", "h10", "h2"}) {
    hands.emplace_back(mj_parseXMLString(hand.c_str(), nullptr, error, sizeof error));
    mjsFrame* const frame = mjs_addFrame(mjs_findBody(scene.get(), "world"), nullptr);
    mjsBody* const world = mjs_findBody(hands.back().get(), "world");
    ASSERT_TRUE(mjs_attach(frame->element, world->element, prefix, ""));
  }
  const testing::Owned<mjModel> m(mj_compile(scene.get(), nullptr));
  ASSERT_TRUE(m) << mjs_getError(scene.get());
  const auto d = Data(m);
  mj_forward(m.get(), d.get());
  ASSERT_EQ(d->nf, 6);
  for (int r = 0; r < 6; ++r) EXPECT_DOUBLE_EQ(d->efc_frictionloss[d->ne + r], .05);
}

TEST_F(Attachments, OnABodyOfAnotherRobotAreFoundThere) {
  for (const std::string joints : {"bend*", "bend1 bend2"}) {
    for (const std::string prefix : {"a", "a/", "wr"})
      EXPECT_EQ(In(kOwn, joints, {{prefix, ""}}, "wrist"), (Levels{0, .05, .05})) << prefix;
  }
}

// A body and an instance that begin with the same letters are no attached robot.
TEST_F(Attachments, AreNotSeenInNamesThatBeginAlikeByChance) {
  const auto [m, error] = Compile(
      "<mujoco>" + Instance("coulomb", Key("joint", "*") + Key("tau_c", ".05")) +
      R"(<worldbody><body name="arm"><joint name="hinge"/><geom size=".1"/><body name="index">
      <plugin plugin="continuum.coulomb" instance="i"/><joint name="i1"/><geom size=".1" pos=".1 0 0"/>
      </body></body></worldbody></mujoco>)");
  ASSERT_TRUE(m) << error;
  const auto d = Data(m);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(d->nf, 2);
}

TEST_F(Attachments, OfJointsWithoutNamesAreWarnedOf) {
  static std::string warnings;
  mju_user_warning = [](const char* text) { warnings += text; };
  const auto arm = [](const std::string& joints) {
    return "<mujoco>" + Instance("coulomb", Key("joint", joints) + Key("tau_c", ".017")) +
           R"(<worldbody><body><freejoint/><geom size=".1"/><body><joint/><geom size=".1"/><body>
           <joint name="b"/><geom size=".1"/></body></body></body></worldbody></mujoco>)";
  };
  EXPECT_TRUE(Compile(arm("b")).model);
  EXPECT_EQ(warnings, "");
  EXPECT_TRUE(Compile(arm("*")).model);
  mju_user_warning = [](const char*) {};
  EXPECT_THAT(warnings, HasSubstr("it leaves out 1 joint without a name: give it one"));
}

}  // namespace
}  // namespace continuum
