#include "identification/diagnosis/numbers_off.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/lengths_and_masses.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using testing::kPeriod;
using testing::Noisy;
using testing::Pendulum;

class NumbersOff : public testing::Bench {
 protected:
  // What becomes of a name for a mass that is 1 % off: the bob's, of another pendulum's logs.
  // left: the error that its fit leaves on logs left out, of 1 without it.
  std::string WordAfter(double left) {
    Pendulum heavier;
    heavier.bob *= 1.01;
    for (int trial = 0; trial < 2; ++trial) {
      const auto u = Command(trial, 200);
      AddLog("log" + std::to_string(trial), "use: train", u,
             Noisy(heavier.Run(u, kPeriod), 1e-4, 0, static_cast<unsigned>(trial + 1)));
    }
    const Experiment e = ReadExperiment("candidates: [link_mass]\n", ", sigma: 0.0001");
    const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum().Xml("", 5e-4)));
    CandidateFitter fitter{&e};
    const Problem null(e, system);
    fitter.whitening = Whitening(null, NoiseOf(e));
    Diagnosis d(e, system);
    d.before = fitter.FitAll(null, null.Start());
    d.sizes = SizesOf(null, d.before.fit.x);
    d.candidates.push_back(Fitted(fitter, d));
    d.before.error.validate = 1, d.candidates[0].fitted.error.validate = left;
    d.verdict.kind = Verdict::Kind::kNamed, d.verdict.named = {0};
    DoubtByNumbers(fitter, d);
    return d.verdict.word();
  }

 private:
  static CandidateResult Fitted(const CandidateFitter& fitter, const Diagnosis& d) {
    std::vector<std::string> skipped;
    const auto all = MakeCandidates(*fitter.experiment, {&d.system}, d.sizes, skipped);
    CandidateResult c{all.at(0)};
    c.fitted = fitter.FitAll(ProblemOf(c, *fitter.experiment), Problem::Vector::Constant(1, 1.0));
    AllowForLengthsAndMasses(fitter, d.sizes, c.hypothesis.system, c.hypothesis.Free(), false,
                             c.fitted);
    return c;
  }
};

TEST_F(NumbersOff, AreNotNamedAloneWhereTheyHelp) { EXPECT_EQ(WordAfter(0.1), "ambiguous"); }
TEST_F(NumbersOff, LeaveAnAdequateModelWhereTheyHardlyDo) {
  EXPECT_EQ(WordAfter(0.99), "adequate");
}

}  // namespace
}  // namespace continuum
