#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "binding/expression.h"
#include "error.h"
#include "identification/diagnosis/diagnosis.h"
#include "support/diagnosis_files.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;
using ::testing::SizeIs;

constexpr char kLevel[] =
    "{effect: formula_friction, name: my_friction, where: 'joint:hinge', level: 'level', "
    "parameters: [{name: level, unit: N*m, initial: 0.02, lower: 0, upper: 1, absent: 0}]}";

// Logs of a pendulum with dry friction by its own integrator; the model has none.
class WrittenLawTest : public testing::Bench {
 protected:
  Experiment ReadWith(const std::string& candidates) {
    if (logs_.empty()) AddLogs();
    return ReadExperiment("candidates: [" + candidates + "]\n");
  }
  Diagnosis Ask(const Experiment& e) {
    DiagnosisOptions options;
    options.placebos = 0;
    options.iterations = 8;
    return Diagnose(e, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), options);
  }
  // The error for one law with a text replaced by another.
  std::string Refusal(const std::string& old, const std::string& by) {
    std::string law = kLevel;
    const std::size_t at = law.find(old);
    EXPECT_NE(at, law.npos) << old;
    try {
      ReadWith(law.replace(at, old.size(), by));
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

 private:
  void AddLogs() {
    Pendulum truth;
    truth.tau_c = 0.05;
    for (int t = 0; t < 3; ++t) {
      const auto u = Command(t, 200);
      const auto q = truth.Run(u, testing::kPeriod);
      for (int replicate = 0; replicate < 2; ++replicate) {
        const auto seed = static_cast<unsigned>(10 * t + replicate);
        AddLog("t" + std::to_string(t) + "_" + std::to_string(replicate),
               "trial: t" + std::to_string(t) + ", use: " + (t < 2 ? "train" : "validate"), u,
               Noisy(q, 1e-3, 0, seed));
      }
    }
  }
};

TEST_F(WrittenLawTest, IsJudgedAsTheSameLawOfTheList) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Diagnosis ours = Ask(ReadWith("coulomb, input_gain"));
  const Diagnosis theirs = Ask(ReadWith(std::string(kLevel) + ", input_gain"));
  ASSERT_TRUE(ours.chosen() && theirs.chosen());
  EXPECT_EQ(ours.chosen()->hypothesis.effect, "coulomb");
  EXPECT_EQ(theirs.chosen()->hypothesis.effect, "my_friction");
  EXPECT_EQ(theirs.chosen()->hypothesis.where, "joint hinge");
  // Ranges and starts of the searches differ: equal to their tolerance.
  EXPECT_NEAR(theirs.chosen()->fitted.error.validate, ours.chosen()->fitted.error.validate, 1e-6);
  EXPECT_NEAR(theirs.chosen()->likelihood, ours.chosen()->likelihood,
              1e-4 * ours.chosen()->likelihood);
  EXPECT_NEAR(theirs.chosen()->fitted.fit.x[0], ours.chosen()->fitted.fit.x[0], 1e-4);
}

TEST_F(WrittenLawTest, IsWrittenIntoTheModelWithItsFormula) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Experiment e = ReadWith(kLevel);
  const Diagnosis d = Ask(e);
  const auto json = testing::WriteFiles(e, d, folder_ / "out").json;
  ASSERT_THAT(json.at("causes"), SizeIs(1)) << json.at("reason");
  const auto& level = json.at("causes")[0].at("parameters").at("level");
  EXPECT_EQ(level.at("unit"), "N*m");
  EXPECT_EQ(level.at("value").get<double>(), d.chosen()->fitted.fit.x[0]);
  const std::string xml = ReadFile(folder_ / "out" / "extended.xml");
  EXPECT_THAT(xml, HasSubstr("continuum.formula_friction"));
  EXPECT_THAT(xml, HasSubstr("key=\"level\" value=\"p1\""));
  const Experiment again = Experiment::Read(folder_ / "out" / "extended.yaml");
  const ModelSpec extended = ModelSpec::Load(folder_ / "out" / "extended.xml");
  EXPECT_EQ(extended.Value("plugin:diagnosis", "p1"), level.at("value").get<double>());
  EXPECT_NO_THROW(Problem(again, extended));
}

TEST_F(WrittenLawTest, StandsBesideAllEffectsOfTheList) {
  const Experiment e = ReadWith("all, " + std::string(kLevel));
  EXPECT_FALSE(e.all_candidates);
  EXPECT_GT(e.candidates.size(), 30u);
  EXPECT_EQ(e.candidates.back().Name(), "my_friction");
}

TEST_F(WrittenLawTest, SaysWhereItIsWrong) {
  EXPECT_THAT(Refusal("level: 'level'", "level: 'level*u'"),
              HasSubstr("candidates[0].level, column 7: expected a number, '(', a function or one "
                        "of q, v, load, level, pi, found 'u'"));
  EXPECT_THAT(Refusal("level: 'level'", "force: 'level'"), HasSubstr("force"));
  EXPECT_THAT(Refusal("my_friction", "coulomb"), HasSubstr("a name of letters and digits"));
  EXPECT_THAT(Refusal("name: level", "name: load"), HasSubstr("that means nothing else"));
  EXPECT_THAT(Refusal("absent: 0", "absent: 2"), HasSubstr("absent"));
  EXPECT_THAT(Refusal(", absent: 0", ""), HasSubstr("a parameter with absent"));
  EXPECT_THAT(Refusal("initial: 0.02", "initial: 2"), HasSubstr("initial"));
}

TEST(Renamed, ChangesNamesAndNothingElse) {
  EXPECT_EQ(Expression::Renamed("b*v + exp(e)*2e-3 - bb", {"b", "e"}, {"e", "p2"}),
            "e*v + exp(p2)*2e-3 - bb");
}

}  // namespace
}  // namespace continuum
