#include "identification/candidates/object_sets.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/candidates/candidate_generator.h"

namespace continuum {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

// Six links on hinges with springs and motors of their own; the fourth motor multiplies its input
// by the angle, and the sixth joint has no name.
std::string Chain(const std::vector<double>& stiffness) {
  std::string bodies, ends, motors;
  for (std::size_t i = 0; i < 6; ++i) {
    bodies += fmt::format(
        R"(<body{} name="link{}"><joint {} axis="0 1 0" stiffness="{}" damping=".01"/>
        <geom type="capsule" size=".01" fromto="0 0 0 .1 0 0" mass=".1"/>)",
        i ? " pos=\".1 0 0\"" : "", i + 1, i < 5 ? fmt::format("name=\"j{}\"", i + 1) : "",
        stiffness[i]);
    ends += "</body>";
    if (i == 5) break;
    motors += fmt::format(R"(<general name="m{0}" joint="j{0}" gaintype="{1}" gainprm="1 {2} 0"/>)",
                          i + 1, i == 3 ? "affine" : "fixed", i == 3 ? ".1" : "0");
  }
  return "<mujoco><option integrator=\"implicitfast\"/><worldbody>" + bodies + ends +
         "</worldbody><actuator>" + motors +
         "</actuator><sensor><jointpos name=\"q1\" joint=\"j1\"/><jointpos name=\"q2\" "
         "joint=\"j2\"/><framepos name=\"p\" objtype=\"body\" "
         "objname=\"link6\"/></sensor></mujoco>";
}

class Sets : public ::testing::Test {
 protected:
  Sets() {
    experiment_.all_candidates = false;
    for (int i = 1; i <= 5; ++i) {
      const std::string n = std::to_string(i);
      experiment_.inputs.push_back({"u" + n, "1", "m" + n, "", false, ""});
    }
    for (const auto& [source, unit] : {std::pair{"q1", "rad"}, {"q2", "rad"}, {"p[0]", "m"}}) {
      Output out;
      out.columns = {source}, out.source = source, out.unit = unit;
      experiment_.outputs.push_back(out);
      experiment_.channels.push_back({source, unit, experiment_.channels.size(), 0, 1});
    }
    Log log;
    log.time = {0, 0.01}, log.measured.assign(3, {0, 1}), log.input.assign(5, {0, 1});
    experiment_.logs = {log};
  }

  Hypothesis First(const std::string& effect) {
    experiment_.candidates = {{effect, "", false}};
    auto all = MakeCandidates(experiment_, base_, sizes_, skipped_);
    EXPECT_THAT(all, Not(IsEmpty())) << effect;
    return all.front();
  }
  std::vector<std::string> Each(const Hypothesis& like) {
    skipped_.clear();
    std::vector<std::string> where;
    for (const Hypothesis& h : AtEach(like, context_, skipped_)) where.push_back(h.where);
    return where;
  }
  std::string Refusal(const Hypothesis& like, const std::vector<std::string>& objects) {
    try {
      At(like, objects, context_);
    } catch (const Error& error) {
      return error.what();
    }
    return "made";
  }

  ModelSpec model_ = ModelSpec::Parse(Chain({1, 2, 2, 4, 1, 1}));
  Experiment experiment_;
  SearchBase base_{&model_};
  Sizes sizes_;
  CandidateContext context_{experiment_, base_, sizes_};
  std::vector<std::string> skipped_;
};

TEST_F(Sets, HaveEachObjectOfAKindInTheModelsOrder) {
  EXPECT_THAT(Each(First("coulomb")),
              ElementsAre("joint j1", "joint j2", "joint j3", "joint j4", "joint j5"));
  EXPECT_THAT(Each(First("viscous")), SizeIs(5));
  EXPECT_THAT(Each(First("sensor_scale")), ElementsAre("sensor q1", "sensor q2", "sensor p[0]"));
  EXPECT_THAT(Each(First("gravity_tilt")), IsEmpty());
  EXPECT_THAT(Each(First("clock_skew")), IsEmpty());
  EXPECT_THAT(skipped_, IsEmpty());
}

TEST_F(Sets, GrowByOneObjectAndShareTheirParameters) {
  const Hypothesis one = AtEach(First("stribeck"), context_, skipped_)[2];
  const Hypothesis two = At(one, {"j3", "j5"}, context_);
  EXPECT_EQ(two.NameAtPlace(), "stribeck at joints j3, j5");
  EXPECT_THAT(two.objects, ElementsAre("j3", "j5"));
  EXPECT_EQ(two.extra.size(), one.extra.size());
  EXPECT_EQ(two.starts, one.starts);
  EXPECT_THAT(two.instance.config, Contains(Pair("joint", "j3 j5")));
  EXPECT_THAT(two.system.Named("joint:j3 j5"), SizeIs(2));
}

TEST_F(Sets, ShowUnitsOfWhatIsMeasuredSentAndMoved) {
  experiment_.inputs[0].unit = "kPa", experiment_.outputs[2].unit = "mm";
  EXPECT_EQ(First("coulomb").units.at("tau_c"), "N*m");
  EXPECT_EQ(First("sensor_scale").units.at("scale"), "");
  EXPECT_EQ(At(First("sensor_bias"), {"p[0]"}, context_).units.at("bias"), "mm");
  EXPECT_EQ(At(First("sensor_drift"), {"q1"}, context_).units.at("rate"), "rad/s");
  EXPECT_EQ(At(First("input_offset"), {"m1"}, context_).units.at("offset"), "Pa");
  EXPECT_EQ(At(First("input_offset"), {"m2"}, context_).units.at("offset"), "");
  const ModelSpec slides = ModelSpec::Parse(
      "<mujoco><worldbody><body><joint name='x' type='slide'/><geom size='.1'/></body></worldbody>"
      "</mujoco>");
  const SearchBase base{&slides};
  const Hypothesis rubs = At(First("coulomb"), {"x"}, {experiment_, base, sizes_});
  EXPECT_EQ(rubs.units.at("tau_c"), "N");
}

TEST_F(Sets, KeepTheChoiceOfTheEffect) {
  experiment_.candidates = {{"load_friction", "", false}};
  const auto all = MakeCandidates(experiment_, base_, sizes_, skipped_);
  ASSERT_GE(all.size(), 2u);
  EXPECT_EQ(At(all[1], {"j2"}, context_).variant, all[1].variant);
  EXPECT_NE(all[1].variant, all[0].variant);
}

// Else it would be there before its parameter moves.
TEST_F(Sets, LeaveAttributesThatDifferAsTheyAreWhereTheEffectIsAbsent) {
  const Hypothesis all = First("stiffness");
  const Hypothesis scaled = At(all, {"j1", "j2", "j4"}, context_);
  ASSERT_THAT(scaled.extra, SizeIs(1));
  EXPECT_EQ(scaled.extra[0].operation, Change::Operation::kScale);
  EXPECT_EQ(scaled.extra[0].name, "k_factor");
  EXPECT_EQ(scaled.extra[0].unit, "1");
  EXPECT_EQ(scaled.null, std::vector<double>{1});
  const Hypothesis same = At(all, {"j2", "j3"}, context_);
  EXPECT_EQ(same.extra[0].operation, Change::Operation::kSet);
  EXPECT_EQ(same.null, std::vector<double>{2});
  const ModelSpec without = ModelSpec::Parse(Chain({0, 2, 2, 4, 1, 1}));
  const SearchBase base{&without};
  const Hypothesis added = At(all, {"j1", "j2"}, {experiment_, base, sizes_});
  EXPECT_EQ(added.extra[0].operation, Change::Operation::kAdd);
  EXPECT_EQ(added.extra[0].name, "k_added");
  EXPECT_EQ(added.extra[0].unit, "N*m/rad");
  EXPECT_EQ(added.null, std::vector<double>{0});
  EXPECT_GE(added.extra[0].lower, 0);
  for (const Hypothesis& h : {scaled, same, added}) {
    const Parameter& p = h.extra[0];
    const ModelAndData null = h.system.Build({{{p.target, p.attribute, h.null[0], p.operation}}});
    for (int j = 0; j < 6; ++j)
      EXPECT_EQ(null.model->jnt_stiffness[j], h.system.model().jnt_stiffness[j]) << h.where;
  }
}

TEST_F(Sets, LeaveOutWhatCannotActAndSayWhy) {
  const Hypothesis lag = First("pt2");
  EXPECT_THAT(lag.objects, ElementsAre("m1", "m2", "m3", "m5"));
  EXPECT_THAT(skipped_, ElementsAre(HasSubstr("pt2 at actuator m4: ")));
  EXPECT_THAT(skipped_.front(), HasSubstr("expected one control with a fixed gain"));
  EXPECT_THAT(Each(lag), ElementsAre("actuator m1", "actuator m2", "actuator m3", "actuator m5"));
  EXPECT_THAT(skipped_, ElementsAre(HasSubstr("pt2 at actuator m4: ")));
  EXPECT_THAT(Refusal(lag, {"m1", "m4"}), HasSubstr("expected one control with a fixed gain"));
}

TEST_F(Sets, OfOutputsHaveOneUnitWhereTheParameterHas) {
  EXPECT_THAT(Refusal(First("sensor_bias"), {"q1", "p[0]"}), HasSubstr("rad and m"));
  EXPECT_EQ(At(First("sensor_scale"), {"q1", "p[0]"}, context_).where, "sensors q1, p[0]");
}

TEST_F(Sets, OfOutputsKeepWhatTheExperimentSaysOfEach) {
  experiment_.outputs[0].measurement.scale = 1.1;
  const Hypothesis h = At(First("sensor_scale"), {"q1", "q2"}, context_);
  EXPECT_EQ(h.extra[0].operation, Change::Operation::kScale);
  EXPECT_EQ(h.null, std::vector<double>{1});
  const Hypothesis turned = [&] {
    experiment_.outputs[0].measurement.scale = -1;
    return At(h, {"q1"}, context_);
  }();
  EXPECT_LT(turned.extra[0].lower, turned.extra[0].initial);
  EXPECT_LT(turned.extra[0].initial, turned.extra[0].upper);
}

TEST_F(Sets, SayWhatTheModelHasAlready) {
  const ModelSpec rough =
      model_.With({}, {{{"coulomb", "dry", {{"joint", "j1"}, {"tau_c", "1"}}}}});
  const SearchBase base{&rough};
  const auto rest = AtEach(First("coulomb"), {experiment_, base, sizes_}, skipped_);
  EXPECT_THAT(rest, SizeIs(4));
  EXPECT_THAT(skipped_, ElementsAre("coulomb at joint j1: coulomb: the model has it already"));
}

}  // namespace
}  // namespace continuum
