// ctest labels: slow
#include "identification/diagnosis/free_lengths.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/report/diagnosis_words.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;

// Free swings of a pendulum that is longer than its model, each recorded once.
class FreeLengths : public testing::Bench {
 protected:
  static constexpr double kNoise = 1e-3;  // [rad]

  // J q'' = −b q' − M g l sin q − τ_f, |τ_f| ≤ τ_c, by symplectic Euler at 20 us with exact stops.
  static std::vector<double> Swing(const Pendulum& p, double q, std::size_t rows) {
    constexpr double h = 2e-5, g = 9.81;
    const double mass = p.bob + p.tip, j = p.inertia + mass * p.length * p.length;
    double v = 0;
    std::vector<double> angle;
    for (std::size_t row = 0; row < rows; ++row) {
      angle.push_back(q);
      for (long k = 0; k < std::lround(testing::kPeriod / h); ++k) {
        const double torque = -p.damping * v - mass * g * p.length * std::sin(q);
        const double free = v + h * torque / j, stop = h * p.tau_c / j;
        v = std::abs(free) <= stop ? 0 : free - std::copysign(stop, free);
        q += h * v;
      }
    }
    return angle;
  }

  Experiment Recorded(const Pendulum& truth) {
    const double from[] = {1.2, 0.8, 1.9, 1.5};
    const std::vector<double> no_input(800, 0.0);
    for (unsigned t = 0; t < 4; ++t)
      AddLog("t" + std::to_string(t),
             "trial: t" + std::to_string(t) + ", use: " + (t < 3 ? "train" : "validate"), no_input,
             Noisy(Swing(truth, from[t], no_input.size()), kNoise, 0, t));
    Pendulum model;
    model.kp = 0, model.damping = 1e-3;
    Write("model.xml", model.Xml("", 2e-3));
    return Experiment::Read(
        Write("experiment.yaml",
              "format: 1\nmodel: model.xml\nstart: measured\nlogs:\n" + logs_ +
                  "outputs: [{column: q, unit: rad, sensor: angle}]\n"
                  "parameters: [{name: b, target: 'joint:hinge', attribute: damping, lower: 0, "
                  "upper: 1}]\n"
                  "candidates: [coulomb, load_friction, position_friction, cubic_stiffness]\n"));
  }

  static Diagnosis Ask(Experiment& e) {
    DiagnosisOptions options;
    options.placebos = 4;
    return DiagnoseWithLengths(e, ModelSpec::Load(e.model), options);
  }
};

TEST_F(FreeLengths, AreFittedWhereTheyHideAFriction) {
  CONTINUUM_LONG_IF_SANITIZED("two whole diagnoses");
  Pendulum truth;
  truth.length = 0.202, truth.damping = 8e-4, truth.tau_c = 5e-3;
  Experiment e = Recorded(truth);
  const Diagnosis d = Ask(e);
  ASSERT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "coulomb");
  EXPECT_NEAR(d.last().fit.x[d.chosen()->first_extra()], truth.tau_c, 1e-4);
  EXPECT_LT(d.after().train, 3 * kNoise);
  ASSERT_TRUE(d.lengths_as_given);
  EXPECT_NE(d.lengths_as_given->verdict, "named");
  EXPECT_GT(d.lengths_as_given->error.train, 10 * kNoise);
  EXPECT_THAT(WhyInWords(d), HasSubstr("Lengths of links were fitted too, within 5 %"));
  EXPECT_THAT(e.parameters, Contains(Field(&Parameter::attribute, "effect:link_length.scale")));
}

TEST_F(FreeLengths, StayWhereTheModelHasThemRight) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  Pendulum truth;
  truth.damping = 8e-4, truth.tau_c = 5e-3;
  Experiment e = Recorded(truth);
  const Diagnosis d = Ask(e);
  ASSERT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "coulomb");
  EXPECT_FALSE(d.lengths_as_given);
  EXPECT_EQ(e.parameters.size(), 1u);
}

}  // namespace
}  // namespace continuum
