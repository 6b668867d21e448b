#include "identification/diagnosis/lengths_and_masses.h"

#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using testing::kPeriod;
using testing::Noisy;
using testing::Pendulum;

class LengthsAndMasses : public testing::Bench {
 protected:
  // Of the squares above the noise that the model as it is leaves of logs of another pendulum, the
  // share that they explain.
  ByLengthsAndMasses By(const Pendulum& truth) {
    AddLogs(truth);
    const Experiment e = ReadExperiment("", ", sigma: 0.0001");
    const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 5e-4)));
    CandidateFitter fitter{&e};
    const Problem null(e, system);
    fitter.whitening = Whitening(null, NoiseOf(e));
    const Fitted as_it_is = fitter.FitAll(null, null.Start());
    const double above = as_it_is.cost - as_it_is.sensitivities->freedom;
    EXPECT_GT(above, 1000);
    const Sizes sizes = SizesOf(null, as_it_is.fit.x);
    ByLengthsAndMasses by = ExplainedByLengthsAndMasses(fitter, sizes, system, {}, as_it_is);
    by.squares /= above;
    return by;
  }
  void AddLogs(const Pendulum& truth) {
    for (int trial = 0; trial < 2; ++trial) {
      const auto u = Command(trial, 200);
      AddLog("log" + std::to_string(trial), "use: train", u,
             Noisy(truth.Run(u, kPeriod), 1e-4, 0, static_cast<unsigned>(trial + 1)));
    }
  }
  double ShareOf(const Pendulum& truth) { return By(truth).squares; }
};

TEST_F(LengthsAndMasses, ThatAreAPerCentOffExplainThemselves) {
  Pendulum longer;
  longer.length *= 1.01, longer.bob *= 0.99;
  const ByLengthsAndMasses by = By(longer);
  EXPECT_GT(by.squares, 0.95);
  EXPECT_GT(by.off, 0.005);
  EXPECT_LT(by.off, 0.025);
}

TEST_F(LengthsAndMasses, DoNotExplainFriction) {
  Pendulum dry;
  dry.tau_c = 0.02;
  EXPECT_LT(ShareOf(dry), 0.3);
}

// One of a tenth is no small deviation: it is less likely a priori, not impossible.
TEST_F(LengthsAndMasses, ExplainLessOfWhatIsFarOff) {
  Pendulum load;
  load.payload = 0.6;
  EXPECT_LT(ShareOf(load), 0.5);
}

const std::string kStiffnessAndDamping =
    "parameters:\n"
    "  - {name: k, target: 'joint:hinge', attribute: stiffness, lower: -1, upper: 1}\n"
    "  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1}\n";

class FittedBesideNumbers : public LengthsAndMasses {
 protected:
  // Stiffness and damping of the logs, with a model like this.
  Fitted FitWith(const Pendulum& model) {
    experiment_.emplace(ReadExperiment(kStiffnessAndDamping, ", sigma: 0.0001"));
    system_.emplace(ModelSpec::Load(Write("model.xml", model.Xml("", 5e-4))));
    fitter_.experiment = &*experiment_;
    const Problem problem(*experiment_, *system_);
    fitter_.whitening = Whitening(problem, NoiseOf(*experiment_));
    return fitter_.FitAll(problem, problem.Start());
  }
  void Allow(bool more_is_left, Fitted& fitted) {
    const Sizes sizes = SizesOf(Problem(*experiment_, *system_), fitted.fit.x);
    AllowForLengthsAndMasses(fitter_, sizes, *system_, {}, more_is_left, fitted);
  }

  std::optional<Experiment> experiment_;
  std::optional<ModelSpec> system_;
  CandidateFitter fitter_{};
};

// Against fits with other models; these keep the inertia of the arm, of which the damping depends.
TEST_F(FittedBesideNumbers, MoveAsTheyDoWhenTheNumbersChange) {
  AddLogs({});
  Pendulum longer, heavier;
  longer.length *= 1.015, heavier.bob *= 1.015;
  const double by_length = FitWith(longer).fit.x[0], by_mass = FitWith(heavier).fit.x[0];
  Fitted fitted = FitWith({});
  const double k = fitted.fit.x[0], moved = std::hypot(by_length - k, by_mass - k);
  Allow(false, fitted);
  EXPECT_NEAR(fitted.sensitivities->uncertainty.by_numbers[0], moved, 0.15 * moved);
}

TEST_F(FittedBesideNumbers, HaveIntervalsThatReachOverThem) {
  Pendulum longer;
  longer.length *= 1.01;
  AddLogs(longer);
  Fitted fitted = FitWith({});
  const Uncertainty before = fitted.sensitivities->uncertainty;
  Allow(true, fitted);
  const Uncertainty& after = fitted.sensitivities->uncertainty;
  const Problem::Vector wide = after.upper - after.lower, narrow = before.upper - before.lower;
  EXPECT_GT(wide[0], 3 * narrow[0]);
  EXPECT_LT(wide[1], 2 * narrow[1]);
  EXPECT_LE(after.lower[0], 0);
  EXPECT_GE(after.upper[0], 0);
  EXPECT_LE(after.lower[1], longer.damping);
  EXPECT_GE(after.upper[1], longer.damping);
}

}  // namespace
}  // namespace continuum
