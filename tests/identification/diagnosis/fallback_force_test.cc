// ctest labels: slow
#include "identification/diagnosis/fallback_force.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "sim/replay/replay.h"
#include "support/diagnosis_files.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;

// Logs of a pendulum with more damping and a payload than its model has, by its own integrator.
class FallbackTest : public Bench {
 protected:
  Diagnosis Ask(const std::string& candidate, double damping, double payload) {
    Pendulum truth;
    truth.damping = damping, truth.payload = payload;
    for (int t = 0; t < 4; ++t) {
      const auto u = Command(t, 200);
      const auto q = truth.Run(u, testing::kPeriod);
      for (int replicate = 0; replicate < 2; ++replicate) {
        const std::string trial = "t" + std::to_string(t);
        AddLog(trial + "_" + std::to_string(replicate),
               "trial: " + trial + ", use: " + (t < 3 ? "train" : "validate"), u,
               Noisy(q, 1e-3, 0, static_cast<unsigned>(10 * t + replicate)));
      }
    }
    e_ = ReadExperiment("candidates: [" + candidate + "]\n");
    DiagnosisOptions options;
    options.placebos = 0;
    return Diagnose(e_, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), options);
  }
  Experiment e_;
};

TEST_F(FallbackTest, WhatNobodyExplainsGetsAForceWithoutACause) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Diagnosis d = Ask("sensor_bias", 0.2, 0);
  ASSERT_EQ(d.verdict.word(), "unexplained");
  ASSERT_TRUE(d.fallback);
  EXPECT_EQ(d.fallback->hypothesis.where, "joint hinge");
  EXPECT_LT(d.fallback->fitted.error.validate, 0.7 * d.before.error.validate);
  const auto out = folder_ / "out";
  const auto files = testing::WriteFiles(e_, d, out);
  const auto& json = files.json;
  EXPECT_THAT(json.at("fallback").at("label"), HasSubstr("no cause"));
  EXPECT_TRUE(json.at("causes").empty());
  EXPECT_THAT(Summary(e_, d, files.run), HasSubstr("fallback  no cause"));
  Experiment written = Experiment::Read(out / kFallbackExperiment);
  const auto logs = Replay(written, ModelSpec::Load(out / kFallbackModel));
  const SplitError error = PooledError(written, logs);
  EXPECT_NEAR(error.validate, d.fallback->fitted.error.validate, 1e-6);
}

// A sway of the sensor, which no force of the robot's state can follow.
TEST_F(FallbackTest, IsNotLookedForWhereForcesReachNothing) {
  for (int t = 0; t < 4; ++t) {
    const auto u = Command(t, 200);
    auto q = Pendulum().Run(u, testing::kPeriod);
    for (std::size_t k = 0; k < q.size(); ++k)
      q[k] += 0.05 * std::sin(37 * testing::kPeriod * static_cast<double>(k) + t);
    AddLog("t" + std::to_string(t), t < 3 ? "use: train" : "use: validate", u,
           Noisy(q, 1e-4, 0, static_cast<unsigned>(t)));
  }
  e_ = ReadExperiment("candidates: [payload]\n");
  std::string said;
  DiagnosisOptions options;
  options.placebos = 0;
  options.progress = [&](const Progress& progress) { said += progress.stage + "\n"; };
  const Diagnosis d = Diagnose(e_, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), options);
  EXPECT_EQ(d.verdict.word(), "unexplained") << d.verdict.reason;
  EXPECT_FALSE(d.fallback);
  EXPECT_THAT(said, ::testing::Not(HasSubstr("force without a cause")));
}

TEST_F(FallbackTest, WhatHasACauseGetsNone) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Diagnosis d = Ask("payload", 0.1, 0.1);
  ASSERT_EQ(d.verdict.word(), "named");
  EXPECT_FALSE(d.fallback);
  const auto out = folder_ / "out";
  MakeFolder(out);
  Write("out/fallback.xml", "of an earlier diagnosis");
  const auto files = testing::WriteFiles(e_, d, out);
  EXPECT_FALSE(std::filesystem::exists(out / kFallbackModel));
  EXPECT_TRUE(files.json.at("fallback").is_null());
}

}  // namespace
}  // namespace continuum
