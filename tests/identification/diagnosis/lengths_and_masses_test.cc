#include "identification/diagnosis/lengths_and_masses.h"

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

// A stiffness of 0.01 N m/rad holds the pendulum as 1.7 % of its weight does; damping nothing does.
TEST_F(LengthsAndMasses, WidenTheIntervalOfWhatMakesUpForThem) {
  Pendulum longer;
  longer.length *= 1.01;
  AddLogs(longer);
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: k, target: 'joint:hinge', attribute: stiffness, lower: -1, upper: 1}\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1}\n",
      ", sigma: 0.0001");
  const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 5e-4)));
  CandidateFitter fitter{&e};
  const Problem problem(e, system);
  fitter.whitening = Whitening(problem, NoiseOf(e));
  Fitted fitted = fitter.FitAll(problem, problem.Start());
  const Uncertainty before = fitted.sensitivities->uncertainty;
  ReachOverLengthsAndMasses(fitter, SizesOf(problem, fitted.fit.x), system, {}, fitted);
  const Uncertainty& after = fitted.sensitivities->uncertainty;
  const Problem::Vector wide = after.upper - after.lower, narrow = before.upper - before.lower;
  EXPECT_GT(wide[0], 0.02);
  EXPECT_GT(wide[0], 3 * narrow[0]);
  EXPECT_LT(wide[1], 2 * narrow[1]);
  EXPECT_LE(after.lower[0], 0);
  EXPECT_GE(after.upper[0], 0);
}

}  // namespace
}  // namespace continuum
