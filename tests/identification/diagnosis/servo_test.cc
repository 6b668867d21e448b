// ctest labels: slow real-data
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "sim/simulation/simulate.h"
#include "support/long_test.h"
#include "support/real_log.h"

namespace continuum {
namespace {

class ServoPendulum : public testing::RealLog {
 protected:
  void SetUp() override { Import("servo_pendulum"); }

  // Mean over the logs of the mean absolute error of the angle [rad].
  static double MeanError(const Problem& problem, const Problem::Vector& x) {
    const Experiment& e = problem.experiment();
    double sum = 0;
    for (std::size_t l = 0; l < e.logs.size(); ++l)
      sum += ScoreLog(e, e.logs[l], problem.Predict(x, l)).front().mae;
    return sum / static_cast<double>(e.logs.size());
  }
};

// Published for these parameters: 82 mrad, with an offset of the angle that is left out here.
TEST_F(ServoPendulum, UnfittedItIsAsFarOffAsTheReadmeSays) {
  const Problem problem(experiment_, ModelSpec::Load(experiment_.model));
  EXPECT_EQ(experiment_.logs.size(), 12u);
  EXPECT_NEAR(MeanError(problem, problem.Start()), 0.0736, 0.0005);
}

// Published after a refit of the same laws: 58 mrad; friction 0.0206 N m, and 0.0183 rad that the
// sensor reads too much, which MJCF's ref counts the other way.
TEST_F(ServoPendulum, CoulombAndViscousFrictionRefittedLeave60Mrad) {
  CONTINUUM_LONG_IF_SANITIZED("a fit to long logs");
  const Problem problem(experiment_, ModelSpec::Load(experiment_.model));
  FitOptions options;
  options.soft = experiment_.soft;
  const Fit fit = FitParameters(problem, problem.Start(), problem.AllLogs(), options);
  EXPECT_LE(MeanError(problem, fit.x), 0.060);
  std::map<std::string, double> found;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) found[problem.parameters()[i].name] = fit.x[i];
  EXPECT_NEAR(found.at("offset"), -0.0183, 0.002);
  EXPECT_NEAR(found.at("tau_c"), 0.0206, 0.002);
}

// On logs of one machine without replicates, left-out groups decide; a delay explains nothing.
TEST_F(ServoPendulum, TheDiagnosisPrefersFrictionThatGrowsWithTheLoadToADelay) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  DiagnosisOptions options;
  options.candidates = {"load_friction", "dead_time"};
  options.placebos = 2;
  const Diagnosis d = Diagnose(experiment_, ModelSpec::Load(experiment_.model), options);
  EXPECT_FALSE(d.noise_limited);
  ASSERT_NE(d.chosen(), nullptr) << d.verdict.reason;
  EXPECT_EQ(d.chosen()->hypothesis.effect, "load_friction") << d.verdict.reason;
  EXPECT_LT(d.after().validate, 0.8 * d.before.error.validate);
  for (const std::size_t i : d.verdict.named)
    EXPECT_NE(d.candidates[i].hypothesis.effect, "dead_time");
}

}  // namespace
}  // namespace continuum
