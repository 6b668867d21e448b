// ctest labels: slow
#include "identification/diagnosis/second_by_folds.h"

#include <map>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;

// Five trials, each recorded once: nobody knows the noise.
class SecondByFolds : public testing::Bench {
 protected:
  Diagnosis Ask(const Pendulum& truth) {
    for (int t = 0; t < 5; ++t) {
      const auto u = testing::Command(t, 200);
      AddLog("t" + std::to_string(t),
             "trial: t" + std::to_string(t) + ", use: " + (t < 4 ? "train" : "validate"), u,
             Noisy(truth.Run(u, testing::kPeriod), 1e-3, 0, static_cast<unsigned>(t)));
    }
    experiment_.emplace(
        ReadExperiment("parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, "
                       "initial: 0.08, lower: 0, upper: 1}\n"
                       "candidates: [payload, coulomb, stiffness, input_offset]\n"));
    DiagnosisOptions options;
    options.placebos = 4, options.effort = Effort::kThorough;
    return Diagnose(*experiment_, ModelSpec::Load(Write("model.xml", Pendulum().Xml())), options);
  }
  std::optional<Experiment> experiment_;
};

TEST_F(SecondByFolds, FindsAFrictionBesideAPayload) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.08, truth.tau_c = 0.05;
  const Diagnosis d = Ask(truth);
  ASSERT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  ASSERT_TRUE(d.partner) << d.verdict.reason;
  const CandidateResult& second = *d.chosen();
  std::map<std::string, double> found;
  found[second.hypothesis.effect] = second.fitted.fit.x[second.first_extra()];
  found[d.partner->hypothesis.effect] = second.fitted.fit.x[d.before.fit.x.size()];
  EXPECT_NEAR(found["payload"], 0.08, 0.008);
  EXPECT_NEAR(found["coulomb"], 0.05, 0.005);
  EXPECT_LT(second.fitted.error.train, 1.2e-3);
  EXPECT_THAT(d.verdict.reason, HasSubstr("passes all rules, and beside it"));
  EXPECT_EQ(second.record.before, d.before.folds.error);
}

TEST_F(SecondByFolds, OneCauseStaysAlone) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.payload = 0.08;
  const Diagnosis d = Ask(truth);
  ASSERT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "payload");
  EXPECT_FALSE(d.partner);
}

}  // namespace
}  // namespace continuum
