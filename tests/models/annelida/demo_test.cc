// ctest labels: slow
#include "models/annelida/demo.h"

#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "identification/diagnosis/diagnosis.h"
#include "sim/experiment/experiment.h"
#include "sim/io/csv.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/annelida/";

// RMS of (simulated − measured)/sigma over all logs.
double Misfit(const Experiment& e, const ModelSpec& robot, const std::vector<Change>& changes) {
  double sum = 0;
  std::size_t count = 0;
  for (const Log& log : e.logs) {
    ModelAndData machine = robot.Build(changes);
    const Trace trace = Simulate(machine, e, log);
    for (std::size_t c = 0; c < e.channels.size(); ++c) {
      for (std::size_t row = 0; row < log.rows(); ++row, ++count) {
        const double error = trace.channel[c][row] - log.measured[c][row];
        sum += std::pow(error / e.outputs[c].sigma, 2);
      }
    }
  }
  return std::sqrt(sum / double(count));
}

// One digit of rounding is left to other compilers.
TEST(AnnelidaDemo, ItsLogsAreTheRecordedOnes) {
  for (const DemoLog& log : RecordDemo(ReadAnnelida(kFolder + "annelida.yaml"))) {
    const CsvTable fresh = CsvTable::Parse(log.csv, log.file);
    const CsvTable kept = CsvTable::Read(kFolder + "demo/" + log.file);
    ASSERT_EQ(fresh.columns(), kept.columns());
    ASSERT_EQ(fresh.rows(), kept.rows());
    for (const std::string& column : fresh.columns()) {
      for (std::size_t row = 0; row < fresh.rows(); ++row) {
        ASSERT_NEAR(fresh.Number(row, column), kept.Number(row, column), 1.1e-5) << kept.Where(row);
      }
    }
  }
}

TEST(AnnelidaDemo, TheHiddenPayloadExplainsItsLogs) {
  const Experiment e = Experiment::Read(kFolder + "demo/annelida.yaml");
  const ModelSpec robot = ModelSpec::Load(e.model);
  const Change payload{"body:tip", "mass", DemoTruth().payload};
  const Change fine{"option", "timestep", 1e-4};
  const double plain = Misfit(e, robot, {}), with = Misfit(e, robot, {payload});
  EXPECT_GT(plain, 5);
  EXPECT_LT(with, 0.25 * plain);
  // With small steps nothing but the noise is left.
  EXPECT_LT(Misfit(e, robot, {payload, fine}), 1.1);
}

// To first order the step of 2 ms leaves the interval short of the truth: cables stick and slip.
TEST(AnnelidaDemo, TheIntervalOfThePayloadHoldsIt) {
  const Experiment e = Experiment::Read(kFolder + "demo/annelida.yaml");
  DiagnosisOptions options;
  options.candidates = {"payload"};
  const Diagnosis d = Diagnose(e, ModelSpec::Load(e.model), options);
  ASSERT_NE(d.chosen(), nullptr) << d.verdict.reason;
  EXPECT_EQ(d.verdict.word(), "named") << d.verdict.reason;
  const Fitted& fitted = d.chosen()->fitted;
  const Eigen::Index mass = d.chosen()->first_extra();
  EXPECT_LT(fitted.sensitivities->uncertainty.lower[mass], DemoTruth().payload);
  EXPECT_GT(fitted.sensitivities->uncertainty.upper[mass], DemoTruth().payload);
  EXPECT_NEAR(fitted.fit.x[mass], DemoTruth().payload, 0.05 * DemoTruth().payload);
}

TEST(AnnelidaDemo, IsSmallEnoughToShip) {
  std::uintmax_t size = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder + "demo")) {
    size += entry.file_size();
  }
  EXPECT_LT(size, 600000);
}

}  // namespace
}  // namespace continuum
