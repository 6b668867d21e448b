#include "identification/report/diagnosis_output.h"

#include <cmath>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/diagnosis/diagnosis.h"
#include "identification/report/parts.h"
#include "support/diagnosis_files.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::DiagnosisFiles;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Noisy;
using ::testing::Not;
using testing::Pendulum;
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
    DiagnosisOptions options;
    options.placebos = 0;
    d_ = std::make_unique<Diagnosis>(
        Diagnose(e_, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), options));
    ASSERT_EQ(d_->verdict.word(), "named") << d_->verdict.reason;
    ASSERT_GT(d_->candidates.size(), 1u);
  }
  std::filesystem::path Out() const { return folder_ / "out"; }
  std::string Page() const { return ReadFile(Out() / "report.html"); }

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
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(files.missing, IsEmpty());
  EXPECT_FALSE(files.json.contains("missing"));
  EXPECT_THAT(Page(), Not(HasSubstr("Not in this report")));
  std::vector<MissingPart> missing;
  ExpectFinite(DiagnosisJson(e_, *d_, files.run, missing), "");
}

// As one that falls so far behind that it got no sensitivities, and that another view speaks for.
TEST_F(DiagnosisOutput, OfARivalWithoutAnIntervalLacksTheIntervalOnly) {
  d_->verdict.kind = Verdict::Kind::kAmbiguous;
  d_->verdict.named = {0, 1};
  d_->candidates[1].fitted.sensitivities.reset();
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(files.missing, IsEmpty());
  const auto& rival = files.json.at("alternatives").at(1).at("parameters").begin().value();
  EXPECT_TRUE(rival.at("value").is_number());
  EXPECT_TRUE(rival.at("ci95").is_null());
  EXPECT_THAT(Summary(e_, *d_, files.run), HasSubstr("\n   or     input_gain"));
  EXPECT_THAT(Page(), HasSubstr("payload or input_gain"));
}

TEST_F(DiagnosisOutput, WithoutAnUncertaintyLacksTheParametersOnly) {
  d_->candidates[0].fitted.sensitivities.reset();
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  ASSERT_EQ(files.json.at("missing").size(), 1u);
  EXPECT_THAT(files.json["missing"][0].get<std::string>(), HasSubstr("parameters: "));
  EXPECT_TRUE(files.json.at("parameters").is_null());
  EXPECT_EQ(files.json.at("verdict"), "named");
  EXPECT_TRUE(files.json.at("error").at("after").at("validate").is_number());
  EXPECT_THAT(Page(), HasSubstr("Not in this report: the extension"));
  EXPECT_THAT(Page(), HasSubstr("Held-out error"));
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
  EXPECT_THAT(names, ElementsAre("simulated", "what is wrong", "the residual"));
  EXPECT_THAT(Page(), HasSubstr("Not in this report: the residual"));
  EXPECT_THAT(Page(), HasSubstr("The missing force on joint hinge"));
}

TEST_F(DiagnosisOutput, NamesWhatTheDiagnosisLacks) {
  d_->missing.push_back({"next experiment", "it diverges"});
  const DiagnosisFiles files = WriteFiles(e_, *d_, Out());
  EXPECT_THAT(files.json.at("missing"), ElementsAre("next experiment: it diverges"));
  EXPECT_THAT(Page(), HasSubstr("Not in this report: next experiment"));
}

}  // namespace
}  // namespace continuum
