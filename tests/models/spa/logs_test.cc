// ctest labels: slow
#include "models/spa/logs.h"

#include <gtest/gtest.h>

#include "identification/fit/fit.h"
#include "identification/problem/path_choice.h"
#include "support/scratch.h"

namespace continuum {
namespace {

// The parameters of the paper's Table I by CVODES, from 20 to 50 % off. Chain and arc are 0.1 % of
// their range apart.
TEST(SpaLogs, GiveTableOneByTheSmoothPath) {
  const testing::Scratch scratch;
  const SpaFile truth = ReadSpa(std::string(CONTINUUM_SOURCE) + "/models/spa/spa.yaml");
  WriteSpaLogs(truth, {}, 1, scratch.folder());
  const Experiment e = Experiment::Read(scratch / "experiment.yaml");
  const ModelSpec system = ModelSpec::Load(e.model);
  Problem problem(e, system);
  ASSERT_EQ(SmoothObstacle(problem), "");
  problem.Follow(Path::kSmooth);
  const Fit fit = FitParameters(problem, problem.Start(), problem.AllLogs());
  EXPECT_TRUE(fit.converged) << fit.message;
  const SpaParameters<double>& p = truth.parameters;
  const double expected[] = {p.x_m,     p.y_m,  p.T_PT1,   p.A,     1,
                             p.d_theta, p.d_dL, p.k_theta, p.k_dL1, p.k_dL3};
  for (int i = 0; i < 10; ++i)
    EXPECT_NEAR(fit.x[i] / expected[i], 1, 5e-3) << problem.parameters()[i].name;
}

}  // namespace
}  // namespace continuum
