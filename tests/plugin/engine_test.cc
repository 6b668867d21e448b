// What every law of the engine obeys as a plugin: state, copies, derivatives, configuration.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "support/engine.h"
#include "support/every_law.h"

namespace continuum {
namespace {

using testing::Arm;
using testing::Drive;
using testing::EffectOf;
using ::testing::HasSubstr;
using testing::Laws;

TEST(Laws, OfThePluginAreAllTested) {
  mj_loadPluginLibrary(CONTINUUM_PLUGIN);
  std::set<std::string> tested;
  for (const auto& [law, config] : Laws()) tested.insert("continuum." + EffectOf(law));
  for (int i = 0; i < mjp_pluginCount(); ++i) {
    const std::string name = mjp_getPluginAtSlot(i)->name;
    if (name == "continuum.wrench") continue;  // a sensor, no law
    EXPECT_TRUE(!name.starts_with("continuum.") || tested.contains(name)) << name;
  }
}

class EveryLaw : public testing::Engine,
                 public ::testing::WithParamInterface<std::tuple<std::string, std::string>> {
 protected:
  static testing::Owned<mjModel> Build() {
    const auto& [law, integrator] = GetParam();
    return Model(Arm(EffectOf(law), Laws().at(law), "integrator=\"" + integrator + "\""));
  }
};
std::vector<std::tuple<std::string, std::string>> Cases() {
  std::vector<std::tuple<std::string, std::string>> all;
  for (const auto& [law, config] : Laws()) {
    for (const char* integrator : {"Euler", "RK4", "implicit", "implicitfast", "discrete"}) {
      all.emplace_back(law, integrator);
    }
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, EveryLaw, ::testing::ValuesIn(Cases()), [](const auto& info) {
  std::string name = std::get<0>(info.param) + "_" + std::get<1>(info.param);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

TEST_P(EveryLaw, ReplaysBitByBitFromASavedState) {
  const auto m = Build();
  const auto d = Data(m);
  Drive(m.get(), d.get(), 300);
  const auto saved = State(m, d);
  Drive(m.get(), d.get(), 300);
  const auto end = State(m, d);
  const auto fresh = Data(m);
  Drive(m.get(), fresh.get(), 17);  // leaves other remains behind
  mj_setState(m.get(), fresh.get(), saved.data(), mjSTATE_INTEGRATION);
  Drive(m.get(), fresh.get(), 300);
  EXPECT_EQ(State(m, fresh), end);
}

TEST_P(EveryLaw, ResetStartsAnew) {
  const auto m = Build();
  const auto d = Data(m);
  Drive(m.get(), d.get(), 200);
  const auto end = State(m, d);
  mj_resetData(m.get(), d.get());
  Drive(m.get(), d.get(), 200);
  EXPECT_EQ(State(m, d), end);
}

TEST_P(EveryLaw, AKeyframeStartsAnew) {
  const auto m = Build();
  const auto d = Data(m), used = Data(m);
  mj_resetDataKeyframe(m.get(), d.get(), 0);
  Drive(m.get(), d.get(), 200);
  Drive(m.get(), used.get(), 150);
  mj_resetDataKeyframe(m.get(), used.get(), 0);
  Drive(m.get(), used.get(), 200);
  EXPECT_EQ(State(m, used), State(m, d));
}

TEST_P(EveryLaw, ACopyRunsOnByItself) {
  const auto m = Build();
  const auto a = Data(m);
  Drive(m.get(), a.get(), 100);
  const testing::Owned<mjData> b(mj_copyData(nullptr, m.get(), a.get()));
  mj_forwardSkip(m.get(), b.get(), mjSTAGE_VEL, 0);
  Drive(m.get(), a.get(), 100);
  Drive(m.get(), b.get(), 100);
  EXPECT_EQ(State(m, a), State(m, b));
}

TEST_P(EveryLaw, RepeatingTheControlStageChangesNothing) {
  const auto m = Build();
  const auto d = Data(m);
  Drive(m.get(), d.get(), 100);
  mj_forward(m.get(), d.get());
  const std::vector<double> qacc(d->qacc, d->qacc + m->nv),
      passive(d->qfrc_passive, d->qfrc_passive + m->nv);
  for (int k = 0; k < 3; ++k) mj_forwardSkip(m.get(), d.get(), mjSTAGE_VEL, 0);
  EXPECT_EQ(passive, std::vector<double>(d->qfrc_passive, d->qfrc_passive + m->nv));
  for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(qacc[i], d->qacc[i], 1e-9);
}

TEST_P(EveryLaw, InverseDynamicsSeesTheLaw) {
  if (std::get<1>(GetParam()) == "discrete") return;  // its acceleration belongs to the step
  const auto m = Build();
  m->opt.enableflags |= mjENBL_FWDINV;
  const auto d = Data(m);
  Drive(m.get(), d.get(), 150);
  mj_forward(m.get(), d.get());
  mj_compareFwdInv(m.get(), d.get());
  EXPECT_LT(d->solver_fwdinv[0], 1e-7);
  EXPECT_LT(d->solver_fwdinv[1], 1e-7);
  mj_inverse(m.get(), d.get());  // passive forces included
  for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(d->qfrc_inverse[i], d->qfrc_actuator[i], 1e-6);
}

TEST_P(EveryLaw, TransitionDerivativeEqualsDifferencesOfSteps) {
  if (std::get<1>(GetParam()) == "RK4") return;  // MuJoCo has no transition derivative for it
  const auto m = Build();
  const auto d = Data(m);
  Drive(m.get(), d.get(), 137);
  const auto n = static_cast<std::size_t>(2 * m->nv + m->na);
  std::vector<double> A(n * n), B(n * m->nu);
  const double eps = 1e-6;
  mjd_transitionFD(m.get(), d.get(), eps, 1, A.data(), B.data(), nullptr, nullptr);
  const auto saved = State(m, d);
  const auto rows = [&](const std::function<void(mjData&)>& move) {
    const auto e = Data(m);
    mj_setState(m.get(), e.get(), saved.data(), mjSTATE_INTEGRATION);
    move(*e);
    mj_step(m.get(), e.get());
    std::vector<double> next(e->qpos, e->qpos + m->nv);  // all joints have one axis
    next.insert(next.end(), e->qvel, e->qvel + m->nv);
    return next;
  };
  const auto expect = [&](const std::vector<double>& M, std::size_t columns, std::size_t column,
                          const std::function<void(mjData&, double)>& move) {
    const auto plus = rows([&](mjData& e) { move(e, eps); });
    const auto minus = rows([&](mjData& e) { move(e, -eps); });
    for (std::size_t i = 0; i < plus.size(); ++i) {
      const double expected = (plus[i] - minus[i]) / (2 * eps);
      EXPECT_NEAR(M[i * columns + column], expected, 1e-5 * (1 + std::abs(expected)));
    }
  };
  for (int j = 0; j < m->nv; ++j) {
    expect(A, n, j, [j](mjData& e, double by) { e.qpos[j] += by; });
    expect(A, n, m->nv + j, [j](mjData& e, double by) { e.qvel[j] += by; });
  }
  for (int u = 0; u < m->nu; ++u)
    expect(B, m->nu, u, [u](mjData& e, double by) { e.ctrl[u] += by; });
}

class Configuration : public testing::Engine {};

TEST_F(Configuration, ErrorsNameAttributeValueRangeAndUnit) {
  const auto error = [](const std::string& law, const std::string& config) {
    return Compile(Arm(law, config, "")).error;
  };
  const std::string joint = Key("joint", "q1");
  EXPECT_THAT(
      error("coulomb", joint + Key("tau_c", "-1")),
      HasSubstr(
          "continuum.coulomb 'i': tau_c: expected a finite number in [0, inf] N*m, found '-1'"));
  EXPECT_THAT(error("coulomb", joint + Key("tau_c", "nan")), HasSubstr("found 'nan'"));
  EXPECT_THAT(error("coulomb", joint + Key("tau_c", "1x")), HasSubstr("found '1x'"));
  EXPECT_THAT(error("stribeck", joint + Key("v_d", "0")),
              HasSubstr("v_d: expected a finite number in ]0"));
  EXPECT_THAT(error("coulomb", Key("joint", "shoulder")), HasSubstr("no joint 'shoulder'"));
  EXPECT_THAT(error("coulomb", Key("joint", "x*")), HasSubstr("no joint 'x*'"));
  EXPECT_THAT(error("coulomb", ""), HasSubstr("one of the keys 'joint' and 'tendon'"));
  EXPECT_THAT(error("coulomb", joint + Key("tendon", "cable")), HasSubstr("both"));
  EXPECT_THAT(error("coulomb", joint + Key("tua", "1")), HasSubstr("tua"));
  EXPECT_THAT(error("load_friction", joint + Key("load", "gear")),
              HasSubstr("transmitted | actuator"));
  EXPECT_THAT(error("backlash", Key("actuator", "pull")), HasSubstr("a position servo"));
  EXPECT_THAT(error("capstan", Key("tendon", "rope")), HasSubstr("no tendon 'rope'"));
}

TEST_F(Configuration, WhatIsNotWrittenDoesNotAct) {
  const auto native = Model(Arm("coulomb", Key("joint", "q1") + Key("tau_c", "0"), ""));
  const auto e = Data(native);
  e->qvel[0] = 0.02;
  mj_forward(native.get(), e.get());
  for (const auto& [law, key, place] : {std::tuple{"coulomb", "joint", "q1"},
                                        {"stribeck", "joint", "q1"},
                                        {"load_friction", "joint", "q1"},
                                        {"position_friction", "joint", "q1"},
                                        {"directional_friction", "joint", "q1"},
                                        {"dahl", "joint", "q1"},
                                        {"lugre", "joint", "q1"},
                                        {"bouc_wen", "joint", "q1"},
                                        {"cubic_stiffness", "joint", "q1"},
                                        {"maxwell", "joint", "q1"},
                                        {"backlash", "actuator", "servo"},
                                        {"tendon_stretch", "tendon", "wire"},
                                        {"slack", "tendon", "wire"},
                                        {"capstan", "tendon", "cable"}}) {
    const auto m = Model(Arm(law, Key(key, place), ""));
    const auto d = Data(m);
    d->qvel[0] = 0.02;
    mj_forward(m.get(), d.get());
    EXPECT_EQ(m->dof_damping[0], native->dof_damping[0]) << law;
    for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(d->qacc[i], e->qacc[i], 1e-12) << law;
  }
  const auto plain = Model(Arm("stribeck", Key("joint", "q1") + Key("tau_c", ".05"), ""));
  const auto d = Data(plain);
  mj_forward(plain.get(), d.get());
  EXPECT_DOUBLE_EQ(d->efc_frictionloss[0], .05);  // no excess at rest
}

// What depends on a position or a direction has no meaning on three axes.
TEST_F(Configuration, AWrongJointTypeIsRefused) {
  const std::string line = "joint 'j': expected a hinge or slide joint, found a ball joint",
                    any = "joint 'j': expected a hinge, slide or ball joint, found a free joint";
  for (const auto& [law, type, refusal] : {std::tuple{"dahl", "ball", line},
                                           {"position_friction", "ball", line},
                                           {"directional_friction", "ball", line},
                                           {"coulomb", "free", any},
                                           {"stribeck", "free", any},
                                           {"load_friction", "free", any},
                                           {"coulomb", "ball", std::string()}}) {
    const auto [model, error] = Compile("<mujoco>" + Instance(law, Key("joint", "j")) +
                                        "<worldbody><body><joint name=\"j\" type=\"" + type +
                                        "\"/><geom size=\".1\"/></body></worldbody></mujoco>");
    EXPECT_EQ(static_cast<bool>(model), refusal.empty()) << law << " " << type;
    EXPECT_THAT(error, HasSubstr(refusal)) << law << " " << type;
  }
}

// Of an instance, not of each compilation, mjData or copy.
TEST_F(Configuration, WarnsOfTheDiscreteIntegratorOnce) {
  static int warnings;
  warnings = 0;
  mju_user_warning = [](const char* text) {
    warnings += std::string_view(text).find("creeps") != std::string_view::npos;
  };
  std::string xml =
      Arm("coulomb", Key("joint", "q1") + Key("tau_c", ".05"), "integrator=\"discrete\"");
  const auto named = [&](const std::string& name) {
    std::string text = xml;
    return text.replace(text.find("name=\"i\""), 8, "name=\"" + name + "\"");
  };
  for (int k = 0; k < 3; ++k) {
    const auto m = Model(named("once"));
    const auto d = Data(m), e = Data(m);
    mj_resetData(m.get(), d.get());
    const testing::Owned<mjData> copy(mj_copyData(nullptr, m.get(), d.get()));
  }
  EXPECT_EQ(warnings, 1);
  Model(named("another"));
  EXPECT_EQ(warnings, 2);
  mju_user_warning = [](const char*) {};
}

TEST_F(Configuration, AnEditedConfigurationIsFollowed) {
  const auto m = Model(Arm("coulomb", Key("joint", "q1") + Key("tau_c", ".05"), ""));
  const auto d = Data(m);
  mj_forward(m.get(), d.get());
  EXPECT_DOUBLE_EQ(d->efc_frictionloss[0], .05);
  char* const text = const_cast<char*>(mj_getPluginConfig(m.get(), 0, "tau_c"));
  std::memcpy(text, ".09", 3);
  mj_forward(m.get(), d.get());
  EXPECT_DOUBLE_EQ(d->efc_frictionloss[0], .09);
}

// "j0" becomes "j*": five joints in the state of one.
TEST_F(Configuration, AnEditThatNeedsMoreStateIsNotFollowed) {
  std::string joints, close;
  for (int i = 0; i < 5; ++i) {
    joints += "<body><joint name=\"j" + std::to_string(i) + "\"/><geom size=\".1\" mass=\"1\"/>";
    close += "</body>";
  }
  const auto m = Model("<mujoco><option gravity=\"0 0 0\"/>" +
                       Instance("coulomb", Key("joint", "j0") + Key("tau_c", ".05")) +
                       "<worldbody>" + joints + close + "</worldbody></mujoco>");
  const auto d = Data(m);
  const_cast<char*>(mj_getPluginConfig(m.get(), 0, "joint"))[1] = '*';
  d->qvel[0] = 1;
  for (int k = 0; k < 10; ++k) mj_step(m.get(), d.get());
  for (int i = 0; i < m->nv; ++i) EXPECT_EQ(d->qfrc_applied[i], 0);
}

TEST_F(Configuration, DataOfOneModelFollowsAnother) {
  const auto a = Model(Arm("coulomb", Key("joint", "q1") + Key("tau_c", ".05"), ""));
  const auto b = Model(Arm("coulomb", Key("joint", "q1") + Key("tau_c", ".07"), ""));
  const auto d = Data(a);
  mj_forward(b.get(), d.get());
  EXPECT_DOUBLE_EQ(d->efc_frictionloss[0], .07);
}

TEST_F(Configuration, BacklashLeavesTheServoFreeInsideTheGap) {
  const auto m = Model(Arm("backlash", Key("actuator", "servo") + Key("gap", ".2"), ""));
  const auto d = Data(m);
  for (const auto& [u, force] : {std::pair{.09, 0.0}, {.3, 5 * .2}, {-.3, -5 * .2}}) {
    d->ctrl[0] = u;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->actuator_force[0], force, 1e-12);
  }
}

}  // namespace
}  // namespace continuum
