#include "identification/candidates/candidate_generator.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

// A link on a hinge and a cable past it, with one effect of ours.
ModelSpec ModelWith(const std::string& effect, const std::string& config) {
  const std::string plugin = effect.empty() ? ""
                                            : "<extension><plugin plugin=\"continuum." + effect +
                                                  "\"><instance name=\"mine\">" + config +
                                                  "</instance></plugin></extension>";
  return ModelSpec::Parse("<mujoco><option integrator=\"implicitfast\"/>" + plugin + R"(
    <worldbody><site name="a" pos=".03 0 .1"/>
      <body><joint name="q" axis="0 1 0"/><joint name="r" axis="1 0 0"/>
        <geom type="capsule" size=".02" fromto="0 0 0 0 0 -.2" mass=".3"/>
        <site name="b" pos=".03 0 -.1"/></body>
    </worldbody>
    <tendon><spatial name="cable"><site site="a"/><site site="b"/></spatial></tendon></mujoco>)");
}

std::string Key(const std::string& key, const std::string& value) {
  return "<config key=\"" + key + "\" value=\"" + value + "\"/>";
}

struct Found {
  std::vector<Hypothesis> candidates;
  std::vector<std::string> skipped;
};

Found Ask(const ModelSpec& model, const std::string& effect, const std::string& where) {
  Experiment e;
  e.all_candidates = false;
  e.candidates = {{effect, where, false}};
  for (int a = 0; a < model.model().nactuator; ++a) {
    e.inputs.emplace_back();
    e.inputs.back().column = "u";
    e.inputs.back().actuator = mj_id2name(&model.model(), mjOBJ_ACTUATOR, a);
  }
  Found found;
  found.candidates = MakeCandidates(e, {&model}, {}, found.skipped);
  return found;
}

std::vector<std::string> FreeNames(const Hypothesis& h) {
  std::vector<std::string> names;
  for (const Parameter& p : h.extra) names.push_back(p.name);
  return names;
}

// Laws that fit too much are tried where they are asked for by name, and nowhere else.
TEST(CandidateGenerator, LeavesOutWhatOnlyAListMayName) {
  const ModelSpec model = ModelWith("", "");
  Experiment all;
  std::vector<std::string> skipped;
  const auto named = [](const std::vector<Hypothesis>& found, const std::string& effect) {
    return std::any_of(found.begin(), found.end(),
                       [&](const auto& h) { return h.effect == effect; });
  };
  const auto found = MakeCandidates(all, {&model}, {}, skipped);
  EXPECT_TRUE(named(found, "load_friction"));
  for (const EffectInfo& effect : Catalog()) {
    if (!effect.only_listed) continue;
    const std::string name(effect.name);
    EXPECT_FALSE(named(found, name)) << name;
    EXPECT_THAT(skipped, ::testing::Not(::testing::Contains(::testing::StartsWith(name)))) << name;
    Experiment some;
    some.all_candidates = false, some.candidates = {{"coulomb", "", false}};
    EXPECT_THAT(Unlisted(some, {}), ::testing::Not(::testing::Contains(name)));
  }
  EXPECT_THAT(Ask(model, "gear_friction", "joint:q").candidates, SizeIs(1));
}

// Viscous friction is the joint's native damping, and k_v only replays the equation as printed.
TEST(CandidateGenerator, FreesWhatOnlyTheLawItselfCanSay) {
  const auto found = Ask(ModelWith("", ""), "stribeck", "joint:q");
  ASSERT_THAT(found.candidates, SizeIs(1));
  const Hypothesis& h = found.candidates.front();
  EXPECT_THAT(FreeNames(h), ElementsAre("tau_c", "S", "v_d"));
  EXPECT_THAT(h.instance.config,
              ElementsAre(Pair("joint", "q"), Pair("tau_mu", "0"), Pair("tau_c", "0.05"),
                          Pair("S", "0.1"), Pair("v_d", "0.3")));
  EXPECT_EQ(h.replaces, "");
}

TEST(CandidateGenerator, LeavesToOtherLawsWhatTheySayAsWell) {
  const auto free = [](const std::string& effect) {
    return FreeNames(Ask(ModelWith("", ""), effect, "joint:q").candidates.front());
  };
  EXPECT_THAT(free("gear_friction"), ElementsAre("tau_c", "S_c", "q_m", "q_e", "v_d", "alpha"));
  EXPECT_THAT(free("lugre"), ElementsAre("sigma_0", "tau_c", "S", "v_s"));
}

TEST(CandidateGenerator, ALawThatContainsCoulombsTakesThePlaceOfTheModels) {
  const ModelSpec model = ModelWith("coulomb", Key("joint", "q") + Key("tau_c", ".02"));
  for (const std::string effect : {"stribeck", "position_friction"}) {
    const auto found = Ask(model, effect, "joint:q");
    ASSERT_THAT(found.candidates, SizeIs(1)) << effect;
    const Hypothesis& h = found.candidates.front();
    EXPECT_EQ(h.replaces, "mine");
    EXPECT_EQ(h.instance.name, "mine");
    EXPECT_THAT(h.instance.config, ::testing::Contains(Pair("tau_c", "0.02")));
    EXPECT_THAT(FreeNames(h), ::testing::Not(::testing::Contains("tau_c")));
  }
  EXPECT_THAT(Ask(model, "load_friction", "joint:q").candidates, SizeIs(2));  // both loads
}

TEST(CandidateGenerator, ALawThatContainsCoulombsHasNoLevelBesideOneOnMoreJoints) {
  const auto found =
      Ask(ModelWith("coulomb", Key("joint", "q r") + Key("tau_c", ".02")), "stribeck", "joint:q");
  ASSERT_THAT(found.candidates, SizeIs(1));
  EXPECT_EQ(found.candidates.front().replaces, "");
  EXPECT_THAT(found.candidates.front().instance.config, ::testing::Contains(Pair("tau_c", "0")));
}

TEST(CandidateGenerator, SaysWhichParameterOfTheModelToFitInstead) {
  const ModelSpec stribeck =
      ModelWith("stribeck", Key("joint", "q") + Key("tau_c", ".02") + Key("tau_mu", ".01"));
  EXPECT_THAT(Ask(stribeck, "viscous", "joint:q").skipped,
              ElementsAre("viscous: the model's stribeck has it: fit its tau_mu"));
  EXPECT_THAT(Ask(stribeck, "coulomb", "joint:q").skipped,
              ElementsAre("coulomb: the model has dry friction"));
  EXPECT_THAT(Ask(stribeck, "stribeck", "joint:q").skipped,
              ElementsAre("stribeck: the model has it already"));
  EXPECT_THAT(Ask(ModelWith("", ""), "viscous", "joint:q").skipped, IsEmpty());
}

// The model's own lag may be too long as well as too short.
TEST(CandidateGenerator, AnInputOfALaggedActuatorMayComeLaterOrSooner) {
  const ModelSpec model = ModelSpec::Parse(R"(<mujoco><worldbody>
    <body><joint name="q"/><geom size="0.1"/></body></worldbody><actuator>
    <general name="valve" joint="q" dyntype="filterexact" dynprm="0.05"/>
    <motor name="motor" joint="q" delay="0.02" nsample="20" interp="linear"/></actuator></mujoco>)");
  EXPECT_DOUBLE_EQ(Ask(model, "pt1", "actuator:valve").candidates.at(0).extra.at(0).lower, -0.05);
  EXPECT_DOUBLE_EQ(Ask(model, "pt1", "actuator:motor").candidates.at(0).extra.at(0).lower, 0);
  EXPECT_DOUBLE_EQ(Ask(model, "dead_time", "actuator:motor").candidates.at(0).extra.at(0).lower,
                   -0.02);
  EXPECT_DOUBLE_EQ(Ask(model, "dead_time", "actuator:valve").candidates.at(0).extra.at(0).lower, 0);
}

TEST(CandidateGenerator, ASiteIsTriedWhereTheExperimentNamesIt) {
  const ModelSpec model = ModelWith("", "");
  const auto found = Ask(model, "external_force", "site:b");
  ASSERT_THAT(found.candidates, SizeIs(1));
  EXPECT_EQ(found.candidates.front().where, "site b");
  EXPECT_EQ(found.candidates.front().extra.front().target, "site:b");
  EXPECT_THAT(Ask(model, "external_force", "").candidates, IsEmpty());  // bodies have no names
}

TEST(CandidateGenerator, FrictionOfATendonIsNoneOfTheJoints) {
  const ModelSpec model = ModelWith("coulomb", Key("tendon", "cable") + Key("tau_c", ".02"));
  EXPECT_THAT(Ask(model, "coulomb", "joint:q").candidates, SizeIs(1));
  EXPECT_THAT(Ask(model, "coulomb", "tendon:cable").skipped,
              ElementsAre("coulomb: the model has it already"));
}

}  // namespace
}  // namespace continuum
