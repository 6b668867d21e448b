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
  double ShareOf(const Pendulum& truth) {
    for (int trial = 0; trial < 2; ++trial) {
      const auto u = Command(trial, 200);
      AddLog("log" + std::to_string(trial), "use: train", u,
             Noisy(truth.Run(u, kPeriod), 1e-4, 0, static_cast<unsigned>(trial + 1)));
    }
    const Experiment e = ReadExperiment("", ", sigma: 0.0001");
    const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 5e-4)));
    CandidateFitter fitter{&e};
    const Problem null(e, system);
    fitter.whitening = Whitening(null, NoiseOf(e));
    CandidateResult as_it_is{Hypothesis{"", "", "", system, {}, {}, "", {}}};
    as_it_is.fitted = fitter.FitAll(null, null.Start());
    const double above = as_it_is.fitted.cost - as_it_is.fitted.sensitivities->freedom;
    EXPECT_GT(above, 1000);
    return ExplainedByLengthsAndMasses(fitter, SizesOf(null, as_it_is.fitted.fit.x), as_it_is) /
           above;
  }
};

TEST_F(LengthsAndMasses, ThatAreAPerCentOffExplainThemselves) {
  Pendulum longer;
  longer.length *= 1.01, longer.bob *= 0.99;
  EXPECT_GT(ShareOf(longer), 0.95);
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

}  // namespace
}  // namespace continuum
