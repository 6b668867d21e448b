#include "identification/report/fit_output.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "identification/identify.h"
#include "identification/report/fit_summary.h"
#include "support/pendulum.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Noisy;
using ::testing::Not;
using testing::Pendulum;
using ::testing::StartsWith;

class FitFiles : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    const auto u = Command(0, 100);
    AddLog("a", "use: train", u, Noisy(Pendulum().Run(u, testing::kPeriod), 1e-3, 0, 1));
    Write("model.xml", Pendulum().Xml());
    experiment_ = ReadExperiment(
        "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.05, "
        "lower: 0, upper: 1}\n");
    IdentifyOptions options;
    options.folder = folder_ / "out";
    result_ = Identify(experiment_, ModelSpec::Load(folder_ / "model.xml"), options);
  }
  // Writes the files anew; its messages are those of the missing parts.
  std::string Written() {
    std::string words;
    for (const MissingPart& part : WriteFit(experiment_, result_, folder_ / "out"))
      words += part.InWords() + "\n";
    return words;
  }
  nlohmann::json Json() const {
    return nlohmann::json::parse(testing::Scratch::Text(folder_ / "out/fit.json"));
  }
  std::string Page() const { return testing::Scratch::Text(folder_ / "out/report.html"); }
  std::string Summary() const { return FitSummary(experiment_, result_, "out"); }

  Experiment experiment_;
  IdentifyResult result_;
};

TEST_F(FitFiles, SayOfNothingThatItIsMissingWhereNothingIs) {
  EXPECT_EQ(Written(), "");
  EXPECT_FALSE(Json().contains("missing"));
  EXPECT_TRUE(Json().contains("ahead"));
  EXPECT_THAT(Page(), Not(HasSubstr("Not in this report")));
  EXPECT_THAT(Summary(), Not(HasSubstr("not in the report")));
}

TEST_F(FitFiles, SayWhatAFineTimeStepGivesWhereItShows) {
  const double value = result_.fit.x[0], error = result_.uncertainty.standard_error[0];
  result_.uncertainty.step = Eigen::VectorXd::Constant(1, 0.005 * value);
  EXPECT_THAT(Summary(), Not(HasSubstr("fine time step")));
  result_.uncertainty.step[0] = 0.2 * value + error;
  EXPECT_THAT(Summary(),
              HasSubstr(fmt::format("; {:.4g} at a fine time step", 1.2 * value + error)));
  result_.uncertainty.standard_error[0] = value;
  EXPECT_THAT(Summary(), Not(HasSubstr("fine time step")));
}

TEST_F(FitFiles, NameWhatTheResultLacks) {
  result_.ahead.reset();
  result_.missing = {{"ahead", "no state is measured"}};
  EXPECT_EQ(Written(), "ahead: no state is measured\n");
  EXPECT_THAT(Json()["missing"], ElementsAre("ahead: no state is measured"));
  EXPECT_FALSE(Json().contains("ahead"));
  EXPECT_THAT(Page(), HasSubstr("Not in this report: ahead"));
}

// As of a fit that was never completed.
TEST_F(FitFiles, WithoutAnUncertaintyLackTheParametersOnly) {
  result_.uncertainty = {};
  EXPECT_THAT(Written(), HasSubstr("parameters: standard errors: 0 of 1\n"));
  EXPECT_THAT(Json()["missing"], ElementsAre("parameters: standard errors: 0 of 1"));
  EXPECT_TRUE(Json()["error"]["train"].is_number());
  EXPECT_THAT(Page(), HasSubstr("Not in this report: parameters"));
  for (const char* part : {"Convergence", "q: autocorrelation", "NRMSE", "fitted"})
    EXPECT_THAT(Page(), HasSubstr(part));
  EXPECT_THAT(Summary(), StartsWith("not in the report: parameters"));
  EXPECT_THAT(Summary(), HasSubstr("\nerror "));
}

TEST_F(FitFiles, WithoutRowsOfATraceLackTheErrorsAndPlotsOnly) {
  result_.logs[0].trace.channel[0].clear();
  Written();
  const nlohmann::json json = Json();
  EXPECT_THAT(json["missing"], ElementsAre(StartsWith("error: log 'a', simulated rows: 0 of 100"),
                                           StartsWith("simulated: ")));
  EXPECT_EQ(json["parameters"][0]["name"], "b");
  EXPECT_TRUE(json.contains("ahead"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/fitted.xml"));
  const std::string page = Page();
  for (const char* part : {"error", "residuals", "logs"})
    EXPECT_THAT(page, HasSubstr("Not in this report: " + std::string(part)));
  EXPECT_THAT(page, HasSubstr("95 % interval"));
  EXPECT_THAT(Summary(), StartsWith("b   "));
}

TEST_F(FitFiles, WithoutAFittedModelDoNotNameIt) {
  std::filesystem::remove_all(folder_ / "out");
  result_.fitted = {};
  result_.missing = {{"fitted_model", "a mesh is gone"}};
  Written();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/fitted.xml"));
  EXPECT_FALSE(Json().contains("fitted_model"));
  EXPECT_THAT(Json()["missing"], ElementsAre("fitted_model: a mesh is gone"));
}

}  // namespace
}  // namespace continuum
