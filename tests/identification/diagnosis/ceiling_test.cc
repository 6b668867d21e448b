// ctest labels: slow
#include <algorithm>

#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

// Logs without replicates, so that folds judge, of a pendulum with dry friction that its model
// does not have.
class Ceiling : public testing::Bench {
 protected:
  Diagnosis Ask(const std::string& candidates) {
    testing::Pendulum truth;
    truth.tau_c = 0.15;
    for (int t = 0; t < 4; ++t) {
      const auto u = testing::Command(t, 200);
      const auto q = testing::Noisy(truth.Run(u, testing::kPeriod), 1e-3, 0, unsigned(t));
      AddLog("t" + std::to_string(t), t < 3 ? "use: train" : "use: validate", u, q);
    }
    const Experiment e = ReadExperiment("candidates: [" + candidates + "]\n");
    DiagnosisOptions options;
    options.placebos = 0;
    return Diagnose(e, ModelSpec::Load(Write("model.xml", testing::Pendulum().Xml())), options);
  }
  static double Gain(const Diagnosis& d) {
    return Median(Gains({"", d.before.folds.error, d.ceiling.error, {}, {}}));
  }
};

TEST_F(Ceiling, IsNotLowerThanWhatACandidateReaches) {
  const Diagnosis d = Ask("coulomb");
  ASSERT_FALSE(d.candidates.empty());
  EXPECT_GE(Gain(d), Median(Gains(d.candidates.front().record)));
  EXPECT_LE(d.ceiling_error.validate, d.after().validate);
  EXPECT_EQ(d.ceiling_by, d.candidates.front().hypothesis.NameAtPlace());
}

TEST_F(Ceiling, KnowsTheDirectionOfMotion) {
  const Diagnosis d = Ask("sensor_bias");
  EXPECT_GT(Gain(d), 0.5);
  EXPECT_EQ(d.ceiling_by, "a friction without a name");
}

}  // namespace
}  // namespace continuum
