#include <gtest/gtest.h>

#include "identification/fit/fit.h"
#include "identification/problem/extended_model.h"
#include "sim/io/decimal.h"
#include "sim/replay/replay.h"
#include "sim/simulation/registration_fit.h"
#include "support/measured_arm.h"

namespace continuum {
namespace {

using testing::MeasuredArm;

class RegisteredFit : public ::testing::Test {
 protected:
  static constexpr char kStiffness[] =
      "parameters:\n  - {name: stiffness, target: \"joint:*\", attribute: stiffness, initial: 0.8, "
      "lower: 0.05, upper: 5}\n";
  // A camera that is turned by some degrees, a marker beside the tip, a clock that is late.
  static Registration Camera() {
    Registration r;
    r.frame = r.marker = r.clock = Registration::Part::kKnown;
    r.rotation = {0.05, 0.12, -0.04};
    r.translation = {0.02, -0.01, 0.015};
    r.offset["tip"] = {0.01, 0, -0.02};
    r.clock_shift = 0.03;
    return r;
  }
  Experiment Measured(const std::string& keys) const {
    Experiment e = arm_.Read(keys + kStiffness);
    MeasuredArm::Measure(e, ModelSpec::Load(e.model), Camera(), 2e-4);
    return e;
  }

  MeasuredArm arm_;
};

TEST_F(RegisteredFit, AWrongCameraIsNotFittedIntoTheStiffness) {
  const Experiment read =
      Measured("registration: {frame: estimate, marker: estimate, clock_shift: estimate}\n");
  const ModelSpec system = ModelSpec::Load(read.model);
  const Experiment e = Registered(read, system);  // at twice the stiffness
  const Problem problem(e, system);
  ASSERT_EQ(problem.parameters().size(), 11u);
  const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs());
  EXPECT_TRUE(fit.converged) << fit.message;
  EXPECT_NEAR(fit.x[0], MeasuredArm::kStiffness, 0.01 * MeasuredArm::kStiffness);
  const Experiment measured = problem.MeasuredBy(fit.x, 0);
  EXPECT_NEAR(measured.registration.clock_shift, 0.03, 5e-4);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(measured.registration.rotation[i], Camera().rotation[i], 5e-3);
    EXPECT_NEAR(measured.registration.offset.at("tip")[i], Camera().offset["tip"][i], 2e-3);
  }
  // The noise is 0.2 mm; validate logs are read with what the train logs have shown.
  const auto r = problem.Residuals(fit.x, problem.AllLogs());
  EXPECT_NEAR(problem.PooledRms(r, {false, true}), 0.2, 0.02) << "mm";
}

TEST_F(RegisteredFit, WithoutTheKeyTheStiffnessTakesTheBlame) {
  const Experiment e = Measured("");
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs());
  // Five times what the registered fit may be off.
  EXPECT_GT(std::abs(fit.x[0] / MeasuredArm::kStiffness - 1), 0.05);
}

TEST_F(RegisteredFit, TheExtendedExperimentKnowsTheRegistration) {
  const Experiment read =
      Measured("registration: {frame: estimate, marker: estimate, clock_shift: estimate}\n");
  const ModelSpec system = ModelSpec::Load(read.model);
  const Experiment e = Registered(read, system);
  for (const Log& log : e.logs) {  // what the camera measured, for the extended experiment to read
    std::string rows = "time,u1,u2,x,y,z\n";
    for (std::size_t k = 0; k < log.rows(); ++k) {
      rows += Decimal(log.time[k]);
      for (const auto& u : log.input) rows += "," + Decimal(u[k]);
      for (const auto& y : log.measured) rows += std::isnan(y[k]) ? "," : "," + Decimal(1e3 * y[k]);
      rows += "\n";
    }
    arm_.folder().Write(log.label + ".csv", rows);
  }
  const Problem problem(e, system);
  const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs());
  const ExtendedModel extension = Extend(problem, problem.system(), fit.x, arm_.folder().folder());
  arm_.folder().Write("extended.xml", extension.xml);
  Experiment extended = Experiment::Read(arm_.folder().Write("extended.yaml", extension.yaml));
  EXPECT_FALSE(extended.registration.estimates());
  const SplitError error = PooledError(extended, Replay(extended, ModelSpec::Load(extended.model)));
  const auto r = problem.Residuals(fit.x, problem.AllLogs());
  EXPECT_NEAR(error.train, problem.PooledRms(r, problem.TrainLogs()), 1e-6);
}

}  // namespace
}  // namespace continuum
