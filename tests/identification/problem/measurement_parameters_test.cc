#include "sim/experiment/measurement_model.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/fit/fit.h"
#include "identification/problem/extended_model.h"
#include "sim/replay/replay.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

// Logs whose sensor differs from the model's by one number, which a fit must find.
class Measured : public Bench {
 protected:
  Experiment Logs(double bias, double scale, double delay, const std::string& parameter,
                  double sine = 0) {
    constexpr double kFine = 1e-3;
    for (int t = 0; t < 2; ++t) {
      const auto u = Command(t, 200);
      std::vector<double> fine_u;
      for (const double v : u) fine_u.insert(fine_u.end(), 10, v);
      const auto fine = Pendulum().Run(fine_u, kFine);
      std::vector<double> q;
      for (std::size_t k = 0; k < u.size(); ++k) {
        const double at = std::max(0.0, testing::kPeriod * static_cast<double>(k) - delay) / kFine;
        const double angle = fine[static_cast<std::size_t>(std::lround(at))];
        q.push_back(scale * (angle + sine * std::sin(angle)) + bias);
      }
      AddLog("t" + std::to_string(t), "use: train", u, q);
    }
    Write("model.xml", Pendulum().Xml());
    return ReadExperiment("parameters:\n  - {name: p, " + parameter + "}\n");
  }
  double Found(const Experiment& e) {
    const ModelSpec system = ModelSpec::Load(folder_ / "model.xml");
    const Problem problem(e, system);
    const Fit fit = FitParameters(problem, problem.Start(), problem.AllLogs());
    const ExtendedModel extension = Extend(problem, problem.system(), fit.x, folder_);
    Write("extended.xml", extension.xml);
    Experiment again = Experiment::Read(Write("extended.yaml", extension.yaml));
    const SplitError error = PooledError(again, Replay(again, ModelSpec::Load(again.model)));
    const auto r = problem.Residuals(fit.x, problem.AllLogs());
    EXPECT_NEAR(error.train, problem.PooledRms(r, problem.AllLogs()), 1e-9);
    return fit.x[0];
  }
};

// The pendulum's own step effect is 0.1 mrad.
TEST_F(Measured, ABiasIsFoundAndWritten) {
  EXPECT_NEAR(
      Found(Logs(0.02, 1, 0, "target: 'sensor:angle', attribute: bias, lower: -1, upper: 1")), 0.02,
      2e-4);
}

TEST_F(Measured, AScaleIsFoundByTheColumnsName) {
  EXPECT_NEAR(Found(Logs(0, 1.05, 0, "target: 'sensor:q', attribute: scale, lower: 0.5, upper: 2")),
              1.05, 1e-3);
}

TEST_F(Measured, AnEccentricityIsFound) {
  const Experiment e =
      Logs(0, 1, 0, "target: 'sensor:q', attribute: sine, lower: -1, upper: 1", 0.03);
  EXPECT_NEAR(Found(e), 0.03, 1e-3);
}

// What is read at a position gives the position back.
TEST_F(Measured, AReadingIsCorrectedForItsEccentricity) {
  Experiment e = Logs(0, 1, 0, "target: 'sensor:q', attribute: bias, lower: -1, upper: 1");
  Measurement& how = e.outputs[0].measurement;
  how = {0.1, 1.2, 0, 0.5, 0, 0.03, -0.02, 2};
  Log& log = e.logs[0];
  for (const double y : {-2.0, 0.0, 0.7}) {
    log.measured[0][3] = 1.2 * (y + how.Eccentricity(y)) + 0.1 + 0.5 * (log.time[3] - log.time[0]);
    EXPECT_NEAR(SignalOf(e, log, 0, 3), y, 1e-12);
  }
}

// A window begins where the drift has come to, not anew.
TEST_F(Measured, ADriftBeginsWithTheRecording) {
  Experiment e = Logs(0, 1, 0, "target: 'sensor:q', attribute: bias, lower: -1, upper: 1");
  const ModelSpec system = ModelSpec::Load(e.model);
  Log& log = e.logs[0];
  log.begin = log.time[0] - 10;
  const double without = Replay(e, system)[0].trace.channel[0][7];
  e.outputs[0].measurement.rate = 0.5;
  const double since = log.time[7] - log.time[0] + 10;
  EXPECT_NEAR(Replay(e, system)[0].trace.channel[0][7] - without, 0.5 * since, 1e-12);
}

TEST_F(Measured, ADelayIsFound) {
  EXPECT_NEAR(
      Found(Logs(0, 1, 0.015,
                 "target: 'sensor:*', attribute: delay, initial: 0.01, lower: 0, upper: 0.1")),
      0.015, 1e-3);
}

TEST_F(Measured, AnUnknownOutputIsNamed) {
  const Experiment e =
      Logs(0, 1, 0, "target: 'sensor:no_such', attribute: bias, lower: -1, upper: 1");
  EXPECT_THROW(Problem(e, ModelSpec::Load(folder_ / "model.xml")), Error);
}

}  // namespace
}  // namespace continuum
