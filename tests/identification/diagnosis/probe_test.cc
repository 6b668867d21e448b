#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/probing.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using testing::Pendulum;

class ProbeTest : public testing::Bench {};

// An excess over a friction that is not there does nothing alone. On top of the friction it is what
// both do less what the friction does, which is known by then.
TEST_F(ProbeTest, NothingIsSimulatedTwice) {
  Pendulum truth;
  truth.tau_c = 0.03;
  const auto u = Command(0, 200);
  AddLog("log", "use: train", u, truth.Run(u, testing::kPeriod));
  const Experiment e = ReadExperiment("candidates: [stribeck]\n");
  const ModelSpec system = ModelSpec::Load(Write("model.xml", Pendulum().Xml()));
  const Problem null(e, system);
  const CandidateFitter fitter{&e};
  const Fitted fitted = fitter.FitAll(null, null.Start());
  std::vector<std::string> skipped;
  const auto all = MakeCandidates(e, {&system}, SizesOf(null, fitted.fit.x), skipped);
  ASSERT_EQ(all.size(), 1u);
  const Problem problem(e, all[0].system, all[0].Free());
  const auto probes = ProbesOf(all[0], problem, {fitted.fit.x, fitted.residuals},
                               fitter.ProjectedResidualOf(fitted), false, {0, 1, 2, 3, 4, 5, 6});
  ASSERT_EQ(probes.size(), all[0].starts.size());  // all at their starts
  for (const Probe& probe : probes) EXPECT_EQ(probe.on_top, (std::vector<bool>{false, true}));
  EXPECT_EQ(problem.evaluations(), 3 * probes.size());  // the friction, the excess, and both
}

// Where something is wrong that is far more than what ten steps in one change, these will do; where
// nothing is, half of them.
TEST_F(ProbeTest, StepsAreAsCoarseAsWhatIsWrongAllows) {
  Pendulum truth;
  const auto u = Command(0, 200);
  AddLog("log", "use: train", u, truth.Run(u, testing::kPeriod));
  const Experiment e = ReadExperiment("");
  const auto coarse_over_own = [&](double damping) {
    Pendulum model;
    model.damping = damping;
    Problem problem(e, ModelSpec::Load(Write("model.xml", model.Xml("", 5e-4))));
    const double own = problem.step();
    const auto r = problem.Residuals(problem.Start(), problem.AllLogs());
    EXPECT_TRUE(StepCoarsely(problem, problem.Start(), r));
    return problem.step() / own;
  };
  EXPECT_NEAR(coarse_over_own(10 * truth.damping), 10, 1e-9);
  EXPECT_NEAR(coarse_over_own(truth.damping), 2.5, 0.5);
}

}  // namespace
}  // namespace continuum
