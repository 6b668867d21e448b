// ctest labels: slow
#include "identification/diagnosis/diagnosis.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/next_experiment.h"
#include "support/diagnosis_files.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Noisy;
using ::testing::Not;
using testing::Pendulum;
using ::testing::SizeIs;
using ::testing::StartsWith;

// Logs of a servo pendulum by its own integrator, four trials of which the last is held out, two
// replicates each; the model knows neither payload nor free play.
class DiagnosisTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 200;
  static constexpr double kNoise = 1e-3;  // rad, of every sample

  void AddTrials(const Pendulum& p, double rho = 0, double gain = 1) {
    for (int t = 0; t < 4; ++t) {
      const auto u = Command(t, kRows);
      auto given = u;
      for (double& v : given) v *= gain;
      const auto q = p.Run(given, testing::kPeriod);
      for (int replicate = 0; replicate < 2; ++replicate) {
        AddLog("t" + std::to_string(t) + "_" + std::to_string(replicate),
               "trial: t" + std::to_string(t) + ", use: " + (t < 3 ? "train" : "validate"), u,
               Noisy(q, kNoise, rho, static_cast<unsigned>(10 * t + replicate)));
      }
    }
  }
  Experiment ReadWith(const std::string& candidates) {
    return ReadExperiment(
        "parameters:\n"
        "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.08, lower: 0, upper: "
        "1}\n"
        "candidates: [" +
        candidates + "]\n");
  }
  Diagnosis Ask(const Experiment& e, int placebos = 4) {
    DiagnosisOptions options;
    options.placebos = placebos;
    options.iterations = 8;
    return Diagnose(e, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), options);
  }
  static std::string Described(const Diagnosis& d) {
    std::string text = d.verdict.word() + ": " + d.verdict.reason + "\n";
    text += fmt::format("  validate error {:.3g}, with a smooth force {:.3g}, after {:.3g}\n",
                        d.before.error.validate, d.ceiling_error.validate, d.after().validate);
    for (const CandidateResult& c : d.candidates) {
      text += fmt::format("  {}: median gain {:.3f}, error {:.2f} times the noise\n",
                          c.hypothesis.Name(), Median(Gains(c.record)), c.record.over_noise);
      for (const auto& failure : c.failures) text += "    " + failure + "\n";
    }
    return text;
  }
};

const std::string kCandidates = "payload, coulomb, stiffness, input_gain, dead_time";

TEST_F(DiagnosisTest, NamesAHiddenPayload) {
  Pendulum truth;
  truth.payload = 0.05;
  AddTrials(truth);
  const Experiment e = ReadWith(kCandidates);
  const Diagnosis d = Ask(e);
  EXPECT_EQ(d.verdict.word(), "named") << Described(d);
  ASSERT_THAT(d.verdict.named, SizeIs(1)) << Described(d);
  const CandidateResult& cause = *d.chosen();
  EXPECT_EQ(cause.hypothesis.effect, "payload");
  EXPECT_EQ(cause.hypothesis.where, "body tip");
  EXPECT_NEAR(cause.fitted.fit.x[1], truth.payload, 0.02 * truth.payload);
  EXPECT_THAT(cause.failures, IsEmpty());
  // Noise: 800 differences tell it to 1/sqrt(1600) = 2.5 %; four times that.
  EXPECT_EQ(d.noise.source, "replicates");
  EXPECT_EQ(d.noise.pairs, 4u);
  EXPECT_NEAR(d.noise.rms, kNoise, 0.1 * kNoise);
  EXPECT_LT(d.after().validate, 0.2 * d.before.error.validate);
  ASSERT_TRUE(d.gain_interval);
  EXPECT_GT(d.gain_interval->low, 0.8);
}

// Of one pendulum nobody can tell its bob from a payload where the bob hangs.
TEST_F(DiagnosisTest, TellsWhatIsNotListedAndWouldDoAsWell) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.05;
  AddTrials(truth);
  const Experiment e = ReadWith("link_mass, coulomb");
  const Diagnosis d = Ask(e);
  ASSERT_EQ(d.verdict.word(), "named") << Described(d);
  EXPECT_EQ(d.chosen()->hypothesis.effect, "link_mass");
  std::vector<std::string> beside;
  for (const CandidateResult& c : d.unlisted) beside.push_back(c.hypothesis.effect);
  EXPECT_THAT(beside, ::testing::Contains("payload")) << Described(d);
  EXPECT_THAT(d.verdict.reason, HasSubstr("not listed"));
  const auto json = testing::WriteFiles(e, d, folder_ / "out").json;
  EXPECT_THAT(json.at("causes").at(0).at("equivalent"), ::testing::Contains("payload"));
}

TEST_F(DiagnosisTest, NoNameStandsThatOneOutsideTheListClearlyOutdoes) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.tau_c = 0.01;
  AddTrials(truth);
  const Diagnosis d = Ask(ReadWith("maxwell, payload"));
  EXPECT_EQ(d.verdict.word(), "unexplained") << Described(d);
  EXPECT_THAT(d.verdict.reason, HasSubstr("not listed")) << Described(d);
}

TEST_F(DiagnosisTest, FindsNothingWhereNothingIsHidden) {
  AddTrials({});
  const Experiment e = ReadWith(kCandidates);
  const Diagnosis d = Ask(e);
  EXPECT_EQ(d.verdict.word(), "adequate") << Described(d);
  EXPECT_THAT(d.verdict.named, IsEmpty());
  EXPECT_EQ(d.chosen(), nullptr);
  EXPECT_LT(d.before.error.train, 1.1 * kNoise);
}

// Else its spread over the folds is that of 1, which says nothing.
TEST_F(DiagnosisTest, TheSizeOfAFactorIsCountedFromOne) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  AddTrials({}, 0, 1.05);
  const Experiment e = ReadWith("input_gain");
  const Diagnosis d = Ask(e, 0);
  ASSERT_NE(d.chosen(), nullptr) << Described(d);
  EXPECT_NEAR(Median(d.chosen()->record.amplitude), 0.05, 0.005) << Described(d);
}

TEST_F(DiagnosisTest, NamesBacklashWhenItIsAmongTheCandidates) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.gap = 0.05;
  AddTrials(truth);
  const Experiment e = ReadWith("backlash, payload, input_gain");
  const Diagnosis d = Ask(e);
  EXPECT_EQ(d.verdict.word(), "named") << Described(d);
  ASSERT_NE(d.chosen(), nullptr);
  EXPECT_EQ(d.chosen()->hypothesis.effect, "backlash");
  EXPECT_NEAR(d.chosen()->fitted.fit.x[1], truth.gap, 0.02 * truth.gap);
}

// The gap in mrad.
class Unlisted : public DiagnosisTest, public ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Gaps, Unlisted, ::testing::Values(10, 25, 60));

TEST_P(Unlisted, BacklashIsNotGivenAnotherName) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.gap = 1e-3 * GetParam();
  AddTrials(truth);
  const Experiment e = ReadWith("payload, coulomb, input_gain");
  const Diagnosis d = Ask(e);
  EXPECT_NE(d.verdict.word(), "named") << Described(d);
  EXPECT_NE(d.verdict.word(), "adequate") << Described(d);
}

TEST_F(DiagnosisTest, NothingIsNamedWhenInputsBelongToOtherLogs) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.05;
  AddTrials(truth);
  Experiment e = ReadWith("payload, input_gain, dead_time");
  const auto logs = e.logs;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    e.logs[l].input = logs[(l + 2) % logs.size()].input;
  }
  const Diagnosis d = Ask(e);
  EXPECT_NE(d.verdict.word(), "named") << Described(d);
  EXPECT_NE(d.verdict.word(), "adequate") << Described(d);
}

TEST_F(DiagnosisTest, NothingIsNamedWhenTheInputsHaveTheOtherSign) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.05;
  AddTrials(truth);
  Experiment e = ReadWith("payload, input_gain, dead_time");
  for (Log& log : e.logs) {
    for (double& u : log.input[0]) u = -u;
  }
  const Diagnosis d = Ask(e);
  EXPECT_NE(d.verdict.word(), "named") << Described(d);
}

TEST_F(DiagnosisTest, ProposesAnInputThatPartsTwoModels) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.05;
  AddTrials(truth);
  const Experiment e = ReadWith("payload, stiffness");
  Diagnosis d = Ask(e, 2);
  ASSERT_THAT(d.candidates, SizeIs(2)) << Described(d);
  CandidateFitter fitter;
  fitter.experiment = &e;
  d.verdict.named = {0};
  EXPECT_EQ(ProposeNext(fitter, d).input, "");
  d.verdict.named = {0, 1};
  const NextExperiment parts = ProposeNext(fitter, d);
  EXPECT_GT(parts.separation, 15);
  EXPECT_THAT(parts.input, Not(HasSubstr("no change")));
  ASSERT_TRUE(parts.log);
  const std::string csv = NextCsv(e, *parts.log);
  EXPECT_THAT(csv, StartsWith(e.time_column + "," + e.inputs[0].column + "\n0,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'),
            static_cast<std::ptrdiff_t>(parts.log->rows() + 1));
  d.candidates[1] = CandidateResult(d.candidates[0]);
  const NextExperiment same = ProposeNext(fitter, d);
  EXPECT_LT(same.separation, 1e-6);
  EXPECT_THAT(same.input, HasSubstr("no change of these inputs"));
  EXPECT_FALSE(same.log);
}

// The pendulum that made the logs has a far finer step.
TEST_F(DiagnosisTest, AFitAtAFineStepTellsHowFarTheStepMovesAValue) {
  const Pendulum truth;
  AddTrials(truth);
  const Experiment e = ReadWith("payload");
  const ModelSpec coarse = ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 4e-3)));
  const Problem problem(e, coarse);
  CandidateFitter fitter;
  fitter.experiment = &e;
  Fitted fitted = fitter.FitAll(problem, problem.Start());
  fitted.sensitivities->uncertainty.step *= 2;  // a first order that is no good
  fitter.FitFinely(problem, {}, fitted);
  const double x = fitted.fit.x[0], off = truth.damping - x;
  EXPECT_GT(std::abs(off), 5 * fitted.sensitivities->uncertainty.standard_error[0]);
  EXPECT_NEAR(fitted.sensitivities->uncertainty.step[0], off, 0.1 * std::abs(off));
  EXPECT_LE(fitted.sensitivities->uncertainty.lower[0], std::min(x, truth.damping));
  EXPECT_GE(fitted.sensitivities->uncertainty.upper[0], std::max(x, truth.damping));
}

TEST_F(DiagnosisTest, ACopyOfALogIsNoReplicate) {
  AddTrials({});
  Experiment e = ReadWith("payload");
  e.logs.push_back(e.logs.front());
  EXPECT_THAT([&] { Ask(e); },
              ::testing::ThrowsMessage<Error>(HasSubstr("a copy is no replicate")));
}

TEST_F(DiagnosisTest, AsksForTwoGroupsToLeaveOut) {
  const auto u = Command(0, kRows);
  AddLog("only", "use: train", u, Pendulum().Run(u, testing::kPeriod));
  const Experiment e = ReadWith("payload");
  EXPECT_THROW(Ask(e), Error);
}

// The noise is known, but there are no logs to leave out on which to try what leaves more than it.
TEST_F(DiagnosisTest, RepeatsOfOneMotionEndWithoutAName) {
  const auto q = Pendulum().Run(Command(0, kRows), testing::kPeriod);
  const auto other = Command(1, kRows);  // so that nothing explains it
  for (unsigned copy = 0; copy < 2; ++copy)
    AddLog("r" + std::to_string(copy), "trial: only, use: train", other, Noisy(q, 1e-5, 0, copy));
  const Experiment e = ReadWith("sensor_drift");
  const Diagnosis d = Ask(e);
  EXPECT_TRUE(d.folds.empty());
  EXPECT_FALSE(d.noise_limited);
  EXPECT_EQ(d.verdict.word(), "unexplained") << Described(d);
  EXPECT_FALSE(d.verdict.complete);
  EXPECT_THAT(d.verdict.reason, HasSubstr("another motion"));
}

TEST_F(DiagnosisTest, AsksForALogToTrainOn) {
  AddTrials({});
  Experiment e = ReadWith("payload");
  for (Log& log : e.logs) log.train = false;
  EXPECT_THROW(Ask(e), Error);
}

TEST_F(DiagnosisTest, APlaceThatIsNotThereIsAnError) {
  AddTrials({});
  Experiment e = ReadWith("payload");
  e.candidates[0].where = "body:nowhere";
  EXPECT_THROW(Ask(e), Error);
}

// Two conditions, of which each has a load of its own, trained on two trials and held out on one.
class PerCondition : public DiagnosisTest {
 protected:
  void AddConditions() {
    unsigned seed = 0;
    for (const auto& [name, payload] : {std::pair{"empty", 0.02}, {"loaded", 0.08}}) {
      Pendulum truth;
      truth.payload = payload;
      for (int t = 0; t < 3; ++t) {
        const auto u = Command(t, kRows);
        const auto q = truth.Run(u, testing::kPeriod);
        const std::string log = name + std::to_string(t);
        for (int replicate = 0; replicate < 2; ++replicate) {
          AddLog(log + "_" + std::to_string(replicate),
                 fmt::format("trial: t{}, use: {}, condition: {}", t, t < 2 ? "train" : "validate",
                             name),
                 u, Noisy(q, kNoise, 0, seed++));
        }
      }
    }
  }
};

TEST_F(PerCondition, EachGetsItsOwnValue) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  AddConditions();
  const Experiment e = ReadWith("payload, {effect: payload, per: condition}, input_gain");
  const Diagnosis d = Ask(e);
  ASSERT_EQ(d.verdict.word(), "named") << Described(d);
  const CandidateResult& c = *d.chosen();
  EXPECT_THAT(c.hypothesis.where, HasSubstr("per condition"));
  ASSERT_THAT(c.hypothesis.extra, SizeIs(2));
  EXPECT_EQ(c.hypothesis.extra[1].name, "mass[loaded]");
  EXPECT_NEAR(c.fitted.fit.x[c.first_extra()], 0.02, 0.002);
  EXPECT_NEAR(c.fitted.fit.x[c.first_extra() + 1], 0.08, 0.002);
  ASSERT_TRUE(c.contrast && d.contrast);
  EXPECT_NEAR(*c.contrast, kNoise, 0.2 * kNoise);
  EXPECT_GT(*d.contrast, 5 * kNoise);
  const auto files = testing::WriteFiles(e, d, folder_ / "out");  // by extended.yaml
  EXPECT_THAT(Summary(e, d, files.run),
              HasSubstr("between   runs under different conditions differ by"));
  EXPECT_NEAR(files.run.after.validate, d.after().validate, 0.02 * d.after().validate);
  const auto& best = files.json.at("candidates").at(0);
  EXPECT_NEAR(best.at("values").at("mass[loaded]"), 0.08, 0.002);
}

TEST_F(PerCondition, AreNeededAndAreOfTheModel) {
  AddTrials(Pendulum());
  const auto wrong = [&](const std::string& effect) {
    try {
      Ask(ReadWith("{effect: " + effect + ", per: condition}"));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(wrong("payload"), HasSubstr("logs of two conditions or more"));
  EXPECT_THAT(wrong("sensor_bias"), HasSubstr("an effect of the model"));
}

TEST_F(DiagnosisTest, WritesFilesThatReproduceTheNamedModel) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.05;
  AddTrials(truth);
  const Experiment e = ReadWith("payload, input_gain");
  const Diagnosis d = Ask(e, 2);
  ASSERT_NE(d.chosen(), nullptr) << Described(d);
  const auto files = testing::WriteFiles(e, d, folder_ / "out");
  EXPECT_THAT(files.missing, IsEmpty());
  EXPECT_FALSE(files.json.contains("missing"));
  EXPECT_NEAR(files.run.after.train, d.after().train, 0.02 * d.after().train);
  EXPECT_NEAR(files.run.after.validate, d.after().validate, 0.02 * d.after().validate);
  EXPECT_EQ(files.json["verdict"], d.verdict.word());
  EXPECT_EQ(files.json["candidates"].size(), d.candidates.size());
  for (const char* file : {"extended.xml", "extended.yaml", "report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  }
  EXPECT_THAT(Summary(e, d, files.run), HasSubstr("payload"));
}

}  // namespace
}  // namespace continuum
