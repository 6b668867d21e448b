// ctest labels: real-data
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "identification/fit/intervals.h"
#include "identification/inverse_dynamics/regressor.h"
#include "support/long_test.h"
#include "support/real_log.h"

namespace continuum {
namespace {

class EmpsFit : public testing::RealLog {
 protected:
  void SetUp() override { Import("emps"); }
};

// Published by least squares on the inverse model: 95.1 kg, 203.5 N s/m, 20.4 N, −3.2 N. That
// weighs the errors differently from a fit of the loop's voltage, which 3 % and 5 % leave room for.
TEST_F(EmpsFit, FindsThePublishedMassAndFrictionFromAWrongStart) {
  const ModelSpec system = ModelSpec::Load(experiment_.model);
  const Problem problem(experiment_, system);
  Problem::Vector start(4);
  start << 70, 300, 10, 0;
  const Fit fit = FitParameters(problem, start, problem.TrainLogs());
  EXPECT_TRUE(fit.converged) << fit.message;
  std::map<std::string, double> found;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) found[problem.parameters()[i].name] = fit.x[i];
  EXPECT_NEAR(found.at("M"), 95.1, 0.03 * 95.1);
  EXPECT_NEAR(found.at("F_v"), 203.5, 0.05 * 203.5);
  EXPECT_NEAR(found.at("F_c"), 20.4, 0.05 * 20.4);
  EXPECT_NEAR(found.at("offset"), 3.2, 0.3);
}

// A reference that waited for the loop's next sample would be 0.5 ms late in the mean of fine
// steps, which is 690 N s/m of viscous friction. What is left is the hold of the force.
TEST_F(EmpsFit, ValuesHardlyDependOnTheStep) {
  CONTINUUM_LONG_IF_SANITIZED("several fits");
  const ModelSpec system = ModelSpec::Load(experiment_.model);
  const Problem problem(experiment_, system);
  Problem::Vector x(4);
  x << 94.2, 203.9, 20.3, 3.1;
  const Uncertainty u = IntervalsOf(problem, x, problem.Residuals(x, problem.TrainLogs()));
  for (Eigen::Index i = 0; i < x.size(); ++i)
    EXPECT_LT(std::abs(u.step[i]), 0.02 * x[i]) << problem.parameters()[i].name;
}

// Published: 95.1 kg, 203.5 N s/m, 20.4 N, and 4.1 % of the force left by the inverse model.
TEST_F(EmpsFit, FindsThePublishedValuesByTheInverseModel) {
  const ModelSpec system = ModelSpec::Load(experiment_.model);
  const Problem problem(experiment_, system);
  const Regression found = FitByRegressor(problem, problem.TrainLogs());
  EXPECT_NEAR(found.x[0], 95.1, 0.01 * 95.1);
  EXPECT_NEAR(found.x[1], 203.5, 0.01 * 203.5);
  EXPECT_NEAR(found.x[2], 20.4, 0.01 * 20.4);
  EXPECT_LE(found.train, 4.1);
  EXPECT_LE(found.validate, 4.3);
}

}  // namespace
}  // namespace continuum
