// Models as people build them: muscles, plugins of others, native friction, poses written by hand,
// saved models, attached robots.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pointwise;

class UserModels : public testing::Engine {};

constexpr const char* kLink = R"(<mujoco>{}<option timestep=".002" integrator="implicitfast" {}/>
  <worldbody><body><joint name="h" axis="0 1 0" {}/>
    <geom type="capsule" size=".02" fromto="0 0 0 0 0 -.3" mass=".5"/></body></worldbody></mujoco>)";

std::string Link(const std::string& extension, const std::string& joint,
                 const std::string& option = "") {
  return fmt::format(fmt::runtime(kLink), extension, option, joint);
}

// MuJoCo finds the length range of a muscle in data that were never init-ed.
TEST_F(UserModels, AMuscleLoadsWithItsNativeLengthRangeBesideAnyEffect) {
  constexpr const char* kMuscle = R"(<mujoco>{}<worldbody><site name="w" pos="0 0 .3"/>
    <body><joint name="h" axis="0 1 0" range="-60 60" damping=".05"/>
      <geom type="capsule" size=".02" fromto="0 0 0 .3 0 0" mass=".3"/>
      <site name="a" pos=".1 0 .03"/><site name="b" pos=".25 0 .03"/></body></worldbody>
    <tendon><spatial name="t"><site site="w"/><site site="a"/><site site="b"/></spatial></tendon>
    <actuator><muscle name="m" tendon="t" force="30"/></actuator></mujoco>)";
  const auto native = Model(fmt::format(fmt::runtime(kMuscle), ""));
  for (const auto& [effect, config] : {std::pair{"coulomb", Key("joint", "h") + Key("tau_c", ".1")},
                                       {"capstan", Key("tendon", "t") + Key("mu", ".1")},
                                       {"maxwell", Key("joint", "h") + Key("k_m", "1")}}) {
    const auto m = Model(fmt::format(fmt::runtime(kMuscle), Instance(effect, config)));
    ASSERT_TRUE(m) << effect;
    EXPECT_EQ(m->actuator_lengthrange[0], native->actuator_lengthrange[0]) << effect;
    EXPECT_EQ(m->actuator_lengthrange[1], native->actuator_lengthrange[1]) << effect;
    const auto d = Data(m);
    RunUntil(m, d, .1);
    EXPECT_TRUE(std::isfinite(d->qpos[0])) << effect;
  }
}

// An actuator plugin of somebody else that pulls with 10 N.
void RegisterPull() {
  static const bool once = [] {
    mjpPlugin plugin;
    mjp_defaultPlugin(&plugin);
    plugin.name = "test.pull";
    plugin.capabilityflags = mjPLUGIN_ACTUATOR;
    plugin.nstate = +[](const mjModel*, int) { return 0; };
    plugin.init = +[](const mjModel*, mjData*, int) { return 0; };
    plugin.reset = +[](const mjModel*, mjtNum*, void*, int) {};
    plugin.compute = +[](const mjModel* m, mjData* d, int i, int) {
      for (int a = 0; a < m->nactuator; ++a) {
        if (m->actuator_plugin[a] == i) d->actuator_force[a] += 10;  // as one that adds up
      }
    };
    mjp_registerPlugin(&plugin);
    return true;
  }();
  (void)once;
}

TEST_F(UserModels, TheForceOfAPluginActuatorCountsWhateverTheOrderOfTheInstances) {
  RegisterPull();
  const std::string ours = "<plugin plugin=\"continuum.capstan\"><instance name=\"i\">" +
                           Key("tendon", "t") + Key("mu", ".3") + "</instance></plugin>";
  const std::string theirs = "<plugin plugin=\"test.pull\"><instance name=\"p\"/></plugin>";
  std::vector<double> tension;
  for (const std::string& order : {ours + theirs, theirs + ours}) {
    const auto m = Model(fmt::format(R"(<mujoco><extension>{}</extension><worldbody>
      <site name="a" pos="-.2 0 .02"/><site name="b" pos="0 0 .02"/>
      <body><joint axis="0 1 0" damping=".1"/><geom size=".02" pos=".1 0 0" mass="1"/>
        <site name="c" pos=".1 0 -.1"/></body></worldbody>
      <tendon><spatial name="t"><site site="a"/><site site="b"/><site site="c"/></spatial></tendon>
      <actuator><plugin tendon="t" plugin="test.pull" instance="p" gear="-1"/></actuator>
      <sensor><plugin name="s" plugin="continuum.capstan" instance="i" objtype="site" objname="a"/>
      </sensor></mujoco>)",
                                     order));
    const auto d = Data(m);
    mj_forward(m.get(), d.get());
    EXPECT_EQ(d->actuator_force[0], 10);  // once
    tension.push_back(d->sensordata[0]);
  }
  EXPECT_THAT(tension, ElementsAre(10, 10));
}

TEST_F(UserModels, ASavedJointHasNoFrictionThatTheUserDidNotWrite) {
  char error[1000] = "";
  const std::string xml = Link(Instance("coulomb", Key("joint", "h") + Key("tau_c", ".05")), "");
  const testing::Owned<mjSpec> spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  const testing::Owned<mjModel> m(mj_compile(spec.get(), nullptr));
  ASSERT_TRUE(m) << mjs_getError(spec.get());
  RunUntil(m, Data(m), .1);
  ASSERT_TRUE(mj_copyBack(spec.get(), m.get()));
  std::vector<char> text(100000);
  ASSERT_EQ(
      mj_saveXMLString(spec.get(), text.data(), static_cast<int>(text.size()), error, sizeof error),
      0)
      << error;
  EXPECT_THAT(text.data(), ::testing::Not(HasSubstr("frictionloss")));
  EXPECT_THAT(text.data(), ::testing::Not(HasSubstr("solimpfriction")));
}

// MuJoCo prints the damping that is ours with six digits: such a model loads, and moves as before.
TEST_F(UserModels, ASavedModelWithManyDigitsLoadsAndMovesAsBefore) {
  char error[1000] = "";
  const std::string xml = Link(
      Instance("stribeck", Key("joint", "h") + Key("tau_mu", "0.0123456789") + Key("tau_c", ".05")),
      "");
  const testing::Owned<mjSpec> spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  const testing::Owned<mjModel> m(mj_compile(spec.get(), nullptr));
  ASSERT_TRUE(m) << mjs_getError(spec.get());
  const auto d = Data(m);
  ASSERT_TRUE(mj_copyBack(spec.get(), m.get()));
  std::vector<char> text(100000);
  ASSERT_EQ(
      mj_saveXMLString(spec.get(), text.data(), static_cast<int>(text.size()), error, sizeof error),
      0)
      << error;
  const auto saved = Model(text.data());
  const auto e = Data(saved);
  EXPECT_EQ(saved->dof_damping[0], 0.0123456789);
  d->qvel[0] = e->qvel[0] = 1;
  RunUntil(m, d, .1), RunUntil(saved, e, .1);
  EXPECT_EQ(d->qpos[0], e->qpos[0]);
}

// Dry friction starts no motion: nothing acts on the joint.
TEST_F(UserModels, APoseWrittenByHandStaysWhereItWasPut) {
  for (const bool ball : {false, true}) {
    const std::string joint = ball ? "type=\"ball\" armature=\"1e-6\"" : "armature=\"1e-6\"";
    const auto m = Model(Link(Instance("coulomb", Key("joint", "h") + Key("tau_c", ".02")), joint,
                              "gravity=\"0 0 0\""));
    const auto d = Data(m);
    for (int i = 0; i < 10; ++i) mj_step(m.get(), d.get());
    std::vector<double> put(m->nq, 1);
    if (ball) put = {std::cos(.5), 0, std::sin(.5), 0};
    std::copy(put.begin(), put.end(), d->qpos);
    mju_zero(d->qvel, static_cast<int>(m->nv));
    mj_forward(m.get(), d.get());
    for (int i = 0; i < 100; ++i) {
      mj_step(m.get(), d.get());
      EXPECT_LT(mju_norm(d->qvel, static_cast<int>(m->nv)), 1e-6);
    }
    for (int k = 0; k < m->nq; ++k) EXPECT_NEAR(d->qpos[k], put[k], 1e-6);
  }
}

// What held before goes on to hold: 0.4 N m of gravity in a band of 1 N m.
TEST_F(UserModels, ALoadIsHeldWhereAPoseWasWrittenByHand) {
  const auto m = Model(Link(Instance("coulomb", Key("joint", "h") + Key("tau_c", "1")), ""));
  const auto d = Data(m);
  d->qpos[0] = .5;
  RunUntil(m, d, 1);
  d->qpos[0] = .6, d->qvel[0] = 0;
  RunUntil(m, d, 3);
  EXPECT_NEAR(d->qpos[0], .6, 1e-5);
}

TEST_F(UserModels, AnEffectAtItsNullLeavesEveryBitOfTheStep) {
  for (const std::string friction :
       {"", "frictionloss=\".1\" solimpfriction=\".8 .9\"", "frictionloss=\".1\""}) {
    const auto swing = [&](const std::string& extension) {
      const auto m = Model(Link(extension, friction));
      const auto d = Data(m);
      d->qpos[0] = 1;
      RunUntil(m, d, 1);
      return d->qpos[0];
    };
    const double native = swing("");
    EXPECT_EQ(swing(Instance("coulomb", Key("joint", "h") + Key("tau_c", "0"))), native);
    EXPECT_EQ(swing(Instance("stribeck", Key("joint", "h") + Key("S", ".5"))), native);
    EXPECT_EQ(swing(Instance("load_friction", Key("joint", "h"))), native);
    EXPECT_EQ(swing(Instance("directional_friction", Key("joint", "h"))), native);
    EXPECT_NE(swing(Instance("coulomb", Key("joint", "h") + Key("tau_c", ".01"))), native);
  }
}

// Arms of six links with MuJoCo's own friction, which swing and come to rest joint by joint.
TEST_F(UserModels, NativeFrictionIsLeftToMujocoBitByBit) {
  const auto arm = [](const std::string& name) {
    std::string bodies, close;
    for (int k = 0; k < 6; ++k) {
      bodies += "<body pos=\"0 0 -.1\"><joint name=\"" + name + std::to_string(k) + "\" axis=\"" +
                (k % 2 ? "1 0 0" : "0 1 0") +
                "\" frictionloss=\".03\" damping=\".01\"/><geom type=\"capsule\" size=\".02\" "
                "fromto=\"0 0 0 0 0 -.08\" mass=\".1\" contype=\"0\" conaffinity=\"0\"/>";
      close += "</body>";
    }
    return bodies + close;
  };
  const auto swing = [&](const std::string& extension) {
    const auto m =
        Model("<mujoco>" + extension +
              "<option integrator=\"implicitfast\"/><worldbody><body pos=\"0 0 1\">" + arm("a") +
              "</body><body pos=\"1 0 1\">" + arm("b") + "</body></worldbody></mujoco>");
    const auto d = Data(m);
    for (int k = 0; k < m->nq; ++k) d->qpos[k] = .3 + .1 * k;
    RunUntil(m, d, 1.5);
    return std::vector<double>(d->qpos + m->nq / 2, d->qpos + m->nq);
  };
  const auto native = swing("");
  for (const std::string effect : {"coulomb", "stribeck", "load_friction", "gear_friction",
                                   "directional_friction", "position_friction", "friction_drift"})
    EXPECT_EQ(swing(Instance(effect, Key("joint", "*"))), native) << effect;
  for (const std::string level : {"0", "p1*abs(v)", "-abs(q)", "0*load"})
    EXPECT_EQ(swing(Instance("formula_friction", Key("joint", "*") + Key("level", level))), native)
        << level;
  EXPECT_EQ(swing(Instance("coulomb", Key("joint", "a*") + Key("tau_c", ".02"))), native)
      << "friction of another arm";
}

// MuJoCo's attach puts a prefix before all names, but not into configurations.
TEST_F(UserModels, AnInstanceFindsTheNamesThatWereAttachedWithIt) {
  const std::string config = Key("joint", "bend*") + Key("tau_c", ".05");
  const std::string arm = R"(<mujoco model="arm"><extension><plugin plugin="continuum.coulomb">
    <instance name="friction">)" +
                          config + R"(</instance></plugin></extension><worldbody>
    <body name="l1"><plugin plugin="continuum.coulomb" instance="friction"/>
      <joint name="bend1" axis="0 1 0"/><geom size=".02" pos="0 0 -.3"/>
      <body name="l2"><joint name="bend2" axis="0 1 0"/><geom size=".02" pos="0 0 -.3"/></body>
    </body></worldbody></mujoco>)";
  char error[1000] = "";
  const testing::Owned<mjSpec> parent(mj_makeSpec());
  std::vector<testing::Owned<mjSpec>> arms;
  for (const char* const prefix : {"a_", "b_", "c-b_"}) {
    arms.emplace_back(mj_parseXMLString(arm.c_str(), nullptr, error, sizeof error));
    ASSERT_TRUE(arms.back()) << error;
    mjsFrame* const frame = mjs_addFrame(mjs_findBody(parent.get(), "world"), nullptr);
    mjsBody* const body = mjs_findBody(arms.back().get(), "l1");
    ASSERT_TRUE(mjs_attach(frame->element, body->element, prefix, ""))
        << mjs_getError(parent.get());
  }
  const testing::Owned<mjModel> m(mj_compile(parent.get(), nullptr));
  ASSERT_TRUE(m) << mjs_getError(parent.get());
  ASSERT_EQ(m->nplugin, 3);
  const auto d = Data(m);
  mj_step(m.get(), d.get());
  ASSERT_EQ(d->nf, 6);
  for (int r = 0; r < 6; ++r) EXPECT_DOUBLE_EQ(d->efc_frictionloss[d->ne + r], .05);
}

// An arm with dry joints and a cable with friction; each instance is kept by a body of its own.
std::string Arm(const std::string& joints, const std::string& tendons) {
  return R"(<mujoco model="arm"><option timestep=".001" integrator="implicitfast"/><extension>
      <plugin plugin="continuum.capstan"><instance name="cf">)" +
         std::string("<config key=\"tendon\" value=\"") + tendons +
         R"("/><config key="mu" value=".3"/></instance></plugin><plugin plugin="continuum.coulomb">
      <instance name="jf"><config key="joint" value=")" +
         joints + R"("/><config key="tau_c" value=".002"/></instance></plugin></extension>
      <worldbody><body name="base" pos="0 0 1"><plugin plugin="continuum.capstan" instance="cf"/>
      <site name="c0" pos="-.05 0 .02"/><site name="c1" pos="0 0 .02"/>
      <body name="l1"><plugin plugin="continuum.coulomb" instance="jf"/>
        <joint name="bend1" axis="0 1 0" stiffness=".5" damping=".01"/>
        <geom type="capsule" fromto="0 0 0 .1 0 0" size=".01" mass=".05" contype="0"/>
        <site name="c2" pos=".05 0 .02"/><body name="l2" pos=".1 0 0">
          <joint name="bend2" axis="0 1 0" stiffness=".5" damping=".01"/>
          <geom type="capsule" fromto="0 0 0 .1 0 0" size=".01" mass=".05" contype="0"/>
          <site name="c3" pos=".05 0 .02"/></body></body></body></worldbody><tendon><spatial name="cable"><site site="c0"/><site site="c1"/>
        <site site="c2"/><site site="c3"/></spatial></tendon>
      <actuator><motor name="pull" tendon="cable" gear="-1"/></actuator></mujoco>)";
}

std::vector<double> Swung(const mjModel& m) {
  const testing::Owned<mjData> d(mj_makeData(&m));
  for (int k = 0; k < 300; ++k) {
    for (int u = 0; u < m.nu; ++u) d->ctrl[u] = 3 + 2 * std::sin(.05 * k);
    mj_step(&m, d.get());
  }
  return {d->qpos, d->qpos + m.nq};
}

// As attach with a suffix, and replicate, name them: "jf_l" and "jf_r", both with the configuration
// of "jf".
TEST_F(UserModels, RobotsThatDifferByASuffixHaveTheirOwnEffects) {
  const std::vector<double> alone = Swung(*Model(Arm("bend1 bend2", "cable")));
  EXPECT_GT(std::abs(alone[0]), .01);
  char error[1000] = "";
  using Names = std::vector<const char*>;
  for (const auto& [joints, tendons] : {std::pair{"bend*", "c*"}, {"bend1 bend2", "cable"}}) {
    for (const Names& suffixes : {Names{"_l", "_r"}, {"0", "1", "2"}, {"-08", "-09", "-10"}}) {
      const testing::Owned<mjSpec> scene(mj_makeSpec());
      std::vector<testing::Owned<mjSpec>> arms;
      for (const char* const suffix : suffixes) {
        arms.emplace_back(
            mj_parseXMLString(Arm(joints, tendons).c_str(), nullptr, error, sizeof error));
        ASSERT_TRUE(arms.back()) << error;
        scene->option = arms.back()->option;
        mjsFrame* const frame = mjs_addFrame(mjs_findBody(scene.get(), "world"), nullptr);
        const mjsBody* const base = mjs_findBody(arms.back().get(), "base");
        ASSERT_TRUE(mjs_attach(frame->element, base->element, "", suffix));
      }
      const testing::Owned<mjModel> m(mj_compile(scene.get(), nullptr));
      ASSERT_TRUE(m) << mjs_getError(scene.get());
      ASSERT_EQ(m->nplugin, 2 * std::ssize(suffixes));
      const std::vector<double> all = Swung(*m);
      for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(all[i], alone[i % 2], 1e-12) << i;
    }
  }
}

// A glob of a robot is not meant for another one that brings the same effect along.
TEST_F(UserModels, GlobsOfARobotLeaveAnAttachedOneToItsOwnInstance) {
  const std::vector<double> alone = Swung(*Model(Arm("bend1 bend2", "cable")));
  char error[1000] = "";
  const testing::Owned<mjSpec> scene(
      mj_parseXMLString(Arm("*", "*").c_str(), nullptr, error, sizeof error));
  ASSERT_TRUE(scene) << error;
  std::vector<testing::Owned<mjSpec>> others;
  for (const char* const prefix : {"b_", "b_b_"}) {
    others.emplace_back(mj_parseXMLString(Arm("*", "*").c_str(), nullptr, error, sizeof error));
    mjsFrame* const frame = mjs_addFrame(mjs_findBody(scene.get(), "world"), nullptr);
    const mjsBody* const base = mjs_findBody(others.back().get(), "base");
    ASSERT_TRUE(mjs_attach(frame->element, base->element, prefix, ""));
  }
  const testing::Owned<mjModel> m(mj_compile(scene.get(), nullptr));
  ASSERT_TRUE(m) << mjs_getError(scene.get());
  ASSERT_EQ(m->nplugin, 6);
  const std::vector<double> all = Swung(*m);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(all[i], alone[i % 2], 1e-12) << i;
}

// Robots of this project that have effects.
std::vector<std::string> Robots() {
  std::vector<std::string> robots;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(CONTINUUM_SOURCE "/models")) {
    if (entry.path().extension() != ".xml") continue;
    char error[1000] = "";
    const testing::Owned<mjModel> m(mj_loadXML(entry.path().c_str(), nullptr, error, sizeof error));
    EXPECT_TRUE(m) << entry.path() << error;
    if (m && m->nplugin > 0) robots.push_back(entry.path());
  }
  return robots;
}

std::vector<double> Pulled(const mjModel& m) {
  const testing::Owned<mjData> d(mj_makeData(&m));
  for (int u = 0; u < m.nu; ++u)
    d->ctrl[u] = .1 * (u + 1) * (m.actuator_ctrllimited[u] ? m.actuator_ctrlrange[2 * u + 1] : 1);
  for (int k = 0; k < 20; ++k) mj_step(&m, d.get());
  return {d->qpos, d->qpos + m.nq};
}

// By a prefix with a separator, and without.
TEST_F(UserModels, EveryRobotKeepsItsEffectsWhenItIsAttached) {
  const auto robots = Robots();
  EXPECT_GE(robots.size(), 12U);
  for (const std::string& file : robots) {
    char error[1000] = "";
    const testing::Owned<mjSpec> child(mj_parseXML(file.c_str(), nullptr, error, sizeof error));
    ASSERT_TRUE(child) << file << error;
    const testing::Owned<mjModel> alone(mj_compile(child.get(), nullptr));
    ASSERT_TRUE(alone) << file << mjs_getError(child.get());
    const std::vector<double> pulled = Pulled(*alone);
    for (const char* const prefix : {"a_", "left"}) {
      const testing::Owned<mjSpec> arm(mj_copySpec(child.get())), scene(mj_makeSpec());
      scene->option = child->option;
      mjsFrame* const frame = mjs_addFrame(mjs_findBody(scene.get(), "world"), nullptr);
      mjsBody* const world = mjs_findBody(arm.get(), "world");
      ASSERT_TRUE(mjs_attach(frame->element, world->element, prefix, ""))
          << mjs_getError(scene.get());
      const testing::Owned<mjModel> m(mj_compile(scene.get(), nullptr));
      ASSERT_TRUE(m) << file << mjs_getError(scene.get());
      EXPECT_EQ(m->nplugin, alone->nplugin) << file;
      EXPECT_THAT(Pulled(*m), Pointwise(DoubleNear(1e-15), pulled)) << file;  // rounding
    }
  }
}

TEST_F(UserModels, ANameThatIsThereAsWrittenIsNoPartOfAPrefix) {
  const auto m =
      Model(R"(<mujoco>)" + Instance("coulomb", Key("joint", "*") + Key("tau_c", ".05")) +
            R"(<worldbody><body name="i_1"><joint name="i1"/><geom size=".1"/>
      <body><joint name="x"/><geom size=".1" pos=".1 0 0"/></body></body></worldbody></mujoco>)");
  const auto d = Data(m);
  mj_forward(m.get(), d.get());
  EXPECT_EQ(d->nf, 2);
}

}  // namespace
}  // namespace continuum
