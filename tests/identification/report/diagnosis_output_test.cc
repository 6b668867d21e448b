#include "identification/report/diagnosis_output.h"

#include <cmath>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/diagnosis/confirmation.h"
#include "identification/diagnosis/diagnosis.h"
#include "identification/diagnosis/unseen_effects.h"
#include "identification/report/diagnosis_words.h"
#include "identification/report/parts.h"
#include "sim/io/csv.h"
#include "support/diagnosis_files.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::Contains;
using testing::DiagnosisFiles;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Noisy;
using ::testing::Not;
using testing::Pendulum;
using ::testing::StartsWith;
using testing::WriteFiles;

// The files of a pendulum with a payload that its model does not have.
class DiagnosisOutput : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    Pendulum truth;
    truth.payload = 0.05;
    for (int t = 0; t < 3; ++t) {
      const auto u = Command(t, 100);
      const auto q = truth.Run(u, testing::kPeriod);
      for (unsigned replicate = 0; replicate < 2; ++replicate) {
        const std::string trial = "t" + std::to_string(t);
        AddLog(trial + "_" + std::to_string(replicate),
               "trial: " + trial + ", use: " + (t < 2 ? "train" : "validate"), u,
               Noisy(q, 1e-3, 0, 10 * static_cast<unsigned>(t) + replicate));
      }
    }
    e_ = ReadExperiment("candidates: [payload, input_gain]\n");
    d_ = std::make_unique<Diagnosis>(
        Found(e_, ModelSpec::Load(Write("model.xml", Pendulum().Xml()))));
    ASSERT_EQ(d_->verdict.word(), "named") << d_->verdict.reason;
    ASSERT_GT(d_->candidates.size(), 1u);
  }
  // Of the same logs in every test: diagnosed once.
  static const Diagnosis& Found(const Experiment& e, const ModelSpec& model) {
    DiagnosisOptions options;
    options.placebos = 0;
    static const Diagnosis found = Diagnose(e, model, options);
    return found;
  }
  std::filesystem::path Out() const { return folder_ / "out"; }
  std::string Page() const { return ReadFile(Out() / "report.html"); }
  // What a reader sees who opens nothing.
  std::string FirstPage() const {
    std::string text;
    const std::string page = Page().substr(0, Page().find("</main>"));  // without scripts
    for (std::size_t at = 0; at < page.size();) {
      const std::size_t fold = page.find("<details>", at), end = page.find("</details>", fold);
      text += page.substr(at, fold - at);
      at = fold == page.npos ? page.size() : end;
    }
    return text;
  }

  Experiment e_;
  std::unique_ptr<Diagnosis> d_;
};

void ExpectFinite(const nlohmann::json& json, const std::string& where) {
  if (json.is_number_float()) {
    EXPECT_TRUE(std::isfinite(json.get<double>())) << where;
  }
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items()) ExpectFinite(value, where + "." + key);
}

TEST_F(DiagnosisOutput, SaysOfNothingThatItIsMissingWhereNothingIs) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(files.missing, IsEmpty());
  EXPECT_FALSE(files.json.contains("missing"));
  EXPECT_THAT(Page(), Not(HasSubstr("Not in this report")));
  std::vector<MissingPart> missing;
  ExpectFinite(DiagnosisJson(e_, *d_, files.run, missing), "");
}

// As one that falls so far behind that it got no sensitivities, and that another view speaks for.
TEST_F(DiagnosisOutput, OfARivalWithoutAnIntervalLacksTheIntervalOnly) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  d_->verdict.kind = Verdict::Kind::kAmbiguous;
  d_->verdict.named = {0, 1};
  d_->candidates[1].fitted.sensitivities.reset();
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(files.missing, IsEmpty());
  const auto& rival = files.json.at("alternatives").at(1).at("parameters").begin().value();
  EXPECT_TRUE(rival.at("value").is_number());
  EXPECT_TRUE(rival.at("ci95").is_null());
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("\n   or     input_gain"));
  EXPECT_THAT(FirstPage(), HasSubstr("payload at body tip or input_gain at actuator servo"));
  EXPECT_THAT(FirstPage(), HasSubstr("<strong>cannot say</strong>"));
}

TEST_F(DiagnosisOutput, WithoutAnUncertaintyLacksTheParametersOnly) {
  d_->candidates[0].fitted.sensitivities.reset();
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  ASSERT_EQ(files.json.at("missing").size(), 1u);
  EXPECT_THAT(files.json["missing"][0].get<std::string>(), HasSubstr("parameters: "));
  EXPECT_TRUE(files.json.at("parameters").is_null());
  EXPECT_EQ(files.json.at("verdict"), "named");
  EXPECT_TRUE(files.json.at("error").at("after").at("validate").is_number());
  EXPECT_THAT(Page(), HasSubstr("Not in this report: Parameters"));
  EXPECT_THAT(FirstPage(), HasSubstr("of the held-out error is removed"));
  EXPECT_THAT(MissingInWords(files.missing), HasSubstr("not in the report: parameters"));
}

TEST_F(DiagnosisOutput, WhatCannotBeWrittenEndsTheJob) {
  std::filesystem::create_directories(Out() / kExtendedModel / "in the way");
  EXPECT_THROW(MeasureExtension(e_, *d_, Out()), Error);
}

TEST_F(DiagnosisOutput, WithoutTheExtendedFilesHasTheErrorsOfTheFitAndNamesNoFile) {
  MakeFolder(Out());
  ExtensionRun run;
  run.after = d_->after();
  run.missing.push_back({"extended model", "it cannot be made"});
  const auto missing = WriteDiagnosis(e_, *d_, run, Out());
  ASSERT_EQ(missing.size(), 1u);
  const auto json = ReadJson(Out() / "diagnosis.json");
  EXPECT_EQ(json.at("error").at("after").at("train"), d_->after().train);
  EXPECT_TRUE(json.at("extended_model").is_null());
  EXPECT_THAT(Page(), HasSubstr("Not in this report: extended model"));
}

TEST_F(DiagnosisOutput, WithoutAnIntervalOfTheGainStatesNone) {
  d_->gain_interval.reset();
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_TRUE(files.json.at("gain").at("ci95").is_null());
  EXPECT_THAT(Page(), HasSubstr("interval not computed"));
}

TEST_F(DiagnosisOutput, WithoutRowsOfATraceLacksWhatIsDrawnOfItOnly) {
  MakeFolder(Out());
  ExtensionRun run = MeasureExtension(e_, *d_, Out());
  run.after_traces[0].channel[0].clear();
  std::vector<std::string> names;
  for (const MissingPart& part : WriteDiagnosis(e_, *d_, run, Out())) names.push_back(part.name);
  EXPECT_THAT(names, ElementsAre("simulated", "what is wrong", "Other deviations", "All logs"));
  EXPECT_THAT(Page(), HasSubstr("Not in this report: what is wrong"));
  EXPECT_THAT(Page(), HasSubstr("<strong>On joint hinge</strong>"));
}

TEST_F(DiagnosisOutput, NamesWhatTheDiagnosisLacks) {
  d_->missing.push_back({"next experiment", "it diverges"});
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(files.json.at("missing"), ElementsAre("next experiment: it diverges"));
  EXPECT_THAT(Page(), HasSubstr("Not in this report: next experiment"));
}

// Nothing on the first page needs a word that only the details explain.
void ExpectNoStatistics(const std::string& page) {
  for (const char* word : {"2 ln L", "lambda", "posterior", "p = ", "family-wise", "likelihood"})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

TEST_F(DiagnosisOutput, OfANamedCauseSaysWhatHowSureWhatChangesAndWhatItGains) {
  d_->unlisted.clear();
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  const std::string page = FirstPage();
  ExpectNoStatistics(page);
  EXPECT_THAT(page, HasSubstr("Cause: payload at body tip"));
  EXPECT_THAT(page, HasSubstr("<strong>sure</strong>"));
  EXPECT_THAT(page, HasSubstr("adds <strong>payload</strong> at body tip: mass 0.0"));
  EXPECT_THAT(page, HasSubstr(GainInWords(*d_, files.run)));
  EXPECT_THAT(page, Not(HasSubstr("&lt;body")));  // lines of the MJCF are folded away
  EXPECT_THAT(Page(), HasSubstr("2 ln L"));
}

TEST_F(DiagnosisOutput, StatesTheIntervalWhereverItStatesTheGain) {
  d_->gain_interval = {0.123, 0.987};
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  const std::string interval = "95 %: 12 … 99 %", page = FirstPage();
  const auto first = page.find(interval);  // in the banner, and under its own heading
  ASSERT_NE(first, page.npos);
  EXPECT_NE(page.find(interval, first + 1), page.npos);
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr(interval));
  EXPECT_EQ(files.json.at("gain").at("ci95"), nlohmann::json({0.123, 0.987}));
}

TEST_F(DiagnosisOutput, ShowsAFoldThatGetsWorse) {
  FoldRecord& record = d_->candidates[0].record;
  ASSERT_GE(record.after.size(), 2u);
  record.after[1] = 2 * record.before[1];
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  const std::string name = d_->folds[1].name;
  EXPECT_THAT(FirstPage(), HasSubstr("fitted without " + name + ", the error there rises"));
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("worse     fitted without " + name));
  EXPECT_FALSE(files.json.at("folds").at(0).at("worse"));
  EXPECT_TRUE(files.json.at("folds").at(1).at("worse"));
}

TEST_F(DiagnosisOutput, MarksAValueAtABound) {
  auto& bound = d_->candidates[0].fitted.sensitivities->uncertainty.at_bound;
  bound.assign(bound.size(), true);
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(FirstPage(), HasSubstr("at its lower bound"));
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("at its lower bound"));
}

TEST_F(DiagnosisOutput, SaysWhatLengthsAndMassesMayDoToASize) {
  Fitted& fitted = d_->candidates[0].fitted;
  Uncertainty& u = fitted.sensitivities->uncertainty;
  u.by_numbers = Eigen::VectorXd::Zero(fitted.fit.x.size());
  EXPECT_THAT(Summary(e_, *d_, WriteFiles(e_, *d_, Out()).run), Not(HasSubstr("% off")));
  u.by_numbers = u.upper - u.lower;
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("kg if lengths and masses are 1.5 % off"));
  EXPECT_GT(files.json.at("causes").at(0).at("parameters").at("mass").at("if_numbers_are_off"), 0);
}

TEST_F(DiagnosisOutput, OfTheUnexplainedShowsTheMissingForceAndNoProbability) {
  d_->verdict = {Verdict::Kind::kUnexplained, {}, "no candidate passes all rules (p = 0.01)"};
  d_->verdict.leading = 0;
  d_->verdict.leading_share = 0.37;
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  const std::string page = FirstPage();
  ExpectNoStatistics(page);
  EXPECT_THAT(page, HasSubstr("no candidate explains it"));
  EXPECT_THAT(page, HasSubstr("payload at body tip comes closest: it takes 37 %"));
  EXPECT_THAT(page, HasSubstr("missing force [N*m]"));
  EXPECT_THAT(page, HasSubstr("No cause was added"));
  EXPECT_THAT(Page(), Not(HasSubstr("1.000")));
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("verdict   unexplained (cannot say)"));
}

TEST_F(DiagnosisOutput, OfTheUnexplainedDoesNotBlameCandidatesThatItHadNoTimeFor) {
  d_->verdict = {Verdict::Kind::kUnexplained, {}, "no candidate passes all rules"};
  d_->left_out = {"a fit of dahl at joint hinge"};
  WriteFiles(e_, *d_, Out());
  EXPECT_THAT(FirstPage(), HasSubstr("no time to find out what"));
  EXPECT_THAT(FirstPage(), Not(HasSubstr("no candidate explains it")));
}

TEST_F(DiagnosisOutput, OfAnAdequateModelAsksForNothing) {
  d_->verdict = {Verdict::Kind::kAdequate, {}, "the error is noise"};
  d_->verdict.complete = true;
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  const std::string page = FirstPage();
  ExpectNoStatistics(page);
  EXPECT_THAT(page, HasSubstr("The model follows these logs"));
  EXPECT_THAT(page, Not(HasSubstr(">The cause<")));
  EXPECT_THAT(page, Not(HasSubstr("of the held-out error")));
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("verdict   adequate (sure)"));
}

// A channel as people name it: with blanks, a comma, and marks of a glob and of HTML.
TEST_F(Bench, AChannelOfAnyNameSurvivesADiagnosis) {
  const std::string name = "joint angle, [left] <1>*";
  for (int t = 0; t < 2; ++t) {
    const auto u = Command(t, 60);
    const std::string log = "run " + std::to_string(t);
    AddLog(log, t ? "use: validate" : "use: train", u,
           Noisy(Pendulum().Run(u, testing::kPeriod), 1e-3, 0, 10 + static_cast<unsigned>(t)));
    std::string csv = ReadFile(folder_ / (log + ".csv"));
    Write(log + ".csv", csv.replace(csv.find(",q\n"), 3, ",\"" + name + "\"\n"));
  }
  const Experiment e = Experiment::Read(
      Write("experiment.yaml", "format: 1\nmodel: model.xml\nstart: rest\nlogs:\n" + logs_ +
                                   "inputs: [{actuator: servo, column: u, unit: rad}]\noutputs:\n"
                                   "  - {column: \"" +
                                   name +
                                   "\", unit: rad, sensor: angle, sigma: 0.001}\n"
                                   "candidates: [sensor_bias, sensor_delay]\n"));
  const Diagnosis d = Diagnose(e, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), {});
  const DiagnosisFiles files = WriteFiles(e, d, folder_ / "out");
  EXPECT_THAT(files.missing, IsEmpty());
  EXPECT_THAT(files.json.at("channels"), ElementsAre(name));
  const std::string page = ReadFile(folder_ / "out/report.html");
  EXPECT_THAT(page, HasSubstr("joint angle, [left] &lt;1&gt;*"));
  const auto simulated = CsvTable::Read(folder_ / "out/simulated/run 0.csv");
  EXPECT_THAT(simulated.columns(), ElementsAre("time", name, name + "_measured"));
}

TEST_F(DiagnosisOutput, OfACauseThatRaisesTheErrorSaysThatItIsNotOffered) {
  MakeFolder(Out());
  ExtensionRun run = MeasureExtension(e_, *d_, Out());
  ASSERT_TRUE(run.offered);
  run.offered = false;
  WriteDiagnosis(e_, *d_, run, Out());
  const std::string page = FirstPage();
  EXPECT_THAT(page, HasSubstr("not offered"));
  EXPECT_THAT(page, HasSubstr("No cause was added"));
  EXPECT_THAT(page, Not(HasSubstr("adds <strong>payload")));
  EXPECT_THAT(page, Not(HasSubstr("error is removed")));
}

TEST_F(DiagnosisOutput, OfACauseThatOnlyAFinerStepShowsSaysWhichStep) {
  MakeFolder(Out());
  ExtensionRun run = MeasureExtension(e_, *d_, Out());
  run.offered = false, run.removed_finely = 0.35;
  WriteDiagnosis(e_, *d_, run, Out());
  const std::string page = FirstPage();
  EXPECT_THAT(page, HasSubstr("at a quarter of that step it falls by 35 %"));
  EXPECT_THAT(page, HasSubstr("Take a time step of 0.000"));
}

TEST_F(DiagnosisOutput, SaysWhatThereWasNoTimeForAndThatItWasInterrupted) {
  d_->left_out = {"folds of dahl"};
  d_->interrupted = true;
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(FirstPage(), HasSubstr("Interrupted"));
  EXPECT_THAT(FirstPage(), HasSubstr("folds of dahl"));
  const std::string summary = Summary(e_, *d_, files.run);
  EXPECT_THAT(summary, HasSubstr("folds of dahl"));
  EXPECT_THAT(summary, HasSubstr("verdict   interrupted, the best so far: named"));
  EXPECT_NE(CertaintyOf(*d_), Certainty::kSure);
}

TEST_F(DiagnosisOutput, SaysWhyACandidateWasNotFitted) {
  using Why = Dismissed::Why;
  d_->dismissed = {{"armature", "", "joint q", 1, 0.5, Why::kExplainsTooLittle},
                   {"dahl", "", "joint q", 0, 1, Why::kNoTimeForALook},
                   {"stribeck", "", "joint q", 9, 0.1, Why::kNoTimeForAFit},
                   {"maxwell", "", "joint q", 9, 0.1, Why::kOthersInVain}};
  const auto all = WriteFiles(e_, *d_, Out()).json.at("candidates");
  const std::size_t last = all.size();
  EXPECT_EQ(all[last - 4]["group"], "not fitted: to first order it explains too little");
  EXPECT_EQ(all[last - 3]["group"], "not fitted: there was no time for a look at it");
  EXPECT_EQ(all[last - 2]["group"], "not fitted: there was no time");
  EXPECT_EQ(all[last - 1]["group"],
            "not fitted: of many that promise more none did better than the best");
}

TEST_F(DiagnosisOutput, SaysWhichEffectsThereWasNoTimeToLookAt) {
  using Why = Dismissed::Why;
  d_->unlisted.clear();
  const std::string named = d_->chosen()->hypothesis.effect;
  d_->dismissed = {{"armature", "", "joint q", 1, 0.5, Why::kExplainsTooLittle},
                   {"armature", "", "joint r", 0, 1, Why::kNoTimeForALook},
                   {named, "", "joint r", 0, 1, Why::kNoTimeForALook}};
  EXPECT_THAT(UnseenEffects(*d_), IsEmpty());
  ASSERT_EQ(CertaintyOf(*d_), Certainty::kSure);
  d_->dismissed.push_back({"dahl", "", "joint q", 0, 1, Why::kNoTimeForALook});
  EXPECT_THAT(UnseenEffects(*d_), ElementsAre("dahl"));
  EXPECT_EQ(CertaintyOf(*d_), Certainty::kLikely);
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("no time to look at dahl"));
}

TEST_F(DiagnosisOutput, IsNoNameWhereMuchOfTheListWasNotLookedAt) {
  EXPECT_FALSE(TooManyUnseen(*d_));
  for (const char* const effect : {"dahl", "stribeck", "maxwell", "pt1", "backlash"})
    d_->dismissed.push_back({effect, "", "joint q", 0, 1, Dismissed::Why::kNoTimeForALook});
  ASSERT_TRUE(TooManyUnseen(*d_));
  d_->verdict.kind = Verdict::Kind::kAmbiguous;  // as the diagnosis does then
  EXPECT_EQ(CertaintyOf(*d_), Certainty::kCannotSay);
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("that there was time for"));
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("dahl, stribeck, maxwell, pt1 and 1 more"));
}

TEST_F(DiagnosisOutput, IsOnlyLikelyWhereMoreThanNoiseIsLeft) {
  d_->unlisted.clear();
  ASSERT_EQ(CertaintyOf(*d_), Certainty::kSure);
  d_->noise_limited = false;
  EXPECT_EQ(CertaintyOf(*d_), Certainty::kLikely);
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("times the noise"));
  d_->noise = {};
  EXPECT_EQ(CertaintyOf(*d_), Certainty::kLikely);
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("how large their noise is"));
}

// It explains enough where it was fitted.
TEST_F(DiagnosisOutput, SaysThatTheBestFailsOnLogsLeftOut) {
  d_->noise_limited = false, d_->verdict.complete = false;
  d_->before.error.validate = d_->after().validate / 2;
  ConfirmOnValidateLogs(*d_);
  EXPECT_THAT(WhyInWords(*d_), StartsWith("The best candidate"));
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("raises the error of the logs that are kept"));
}

TEST_F(DiagnosisOutput, OfTwoCorrectionsSaysThatOtherNumbersMayBeOff) {
  EXPECT_FALSE(OnlyCorrections(*d_));
  d_->partner = Partner{d_->candidates[1].hypothesis};
  d_->partner->correction = Partner::Correction::kBoth;
  d_->verdict.kind = Verdict::Kind::kAmbiguous;
  ASSERT_TRUE(OnlyCorrections(*d_));
  EXPECT_THAT(HeadlineOf(*d_), StartsWith("Numbers that are a little off: input_gain at"));
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("such as lengths"));
  EXPECT_EQ(CertaintyOf(*d_), Certainty::kCannotSay);
  EXPECT_THAT(NextStepsInWords(e_, *d_, {}).front(), HasSubstr("Measure lengths"));
}

TEST_F(DiagnosisOutput, OfAnyOfSeveralNumbersSaysThatOthersMayBeOff) {
  d_->verdict.kind = Verdict::Kind::kAmbiguous;
  d_->verdict.named = {0, 1}, d_->verdict.numbers = true;
  EXPECT_THAT(HeadlineOf(*d_), StartsWith("A number that is a little off: "));
  EXPECT_THAT(WhyInWords(*d_), StartsWith("Each changes a number by a few per cent."));
  EXPECT_THAT(NextStepsInWords(e_, *d_, {}), Contains(HasSubstr("Measure lengths")));
}

TEST_F(DiagnosisOutput, SaysThatLengthsAndMassesAreEnough) {
  d_->verdict = Verdict::Adequate("");
  d_->verdict.numbers_off = 0.013, d_->verdict.complete = false;
  EXPECT_THAT(HeadlineOf(*d_), HasSubstr("but for lengths and masses"));
  EXPECT_THAT(WhyInWords(*d_), HasSubstr("at most 1.3 % off"));
  EXPECT_EQ(CertaintyOf(*d_), Certainty::kLikely);
  EXPECT_THAT(NextStepsInWords(e_, *d_, {}), Contains(HasSubstr("Measure lengths")));
}

}  // namespace
}  // namespace continuum
