// ctest labels: real-data
#include <cmath>

#include <gtest/gtest.h>

#include "error.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/simulate.h"
#include "support/real_log.h"

namespace continuum {
namespace {

class Trunk : public testing::RealLog {
 protected:
  void SetUp() override { Import("trunk"); }

  // RMS distance of the third disk [m] in one window.
  double TipError(const Log& log) const {
    const ModelSpec system = ModelSpec::Load(experiment_.model);
    ModelAndData machine = system.Build(log.set);
    const Trace trace = Simulate(machine, experiment_, log);
    double sum = 0;
    for (std::size_t k = 0; k < log.rows(); ++k) {
      for (std::size_t c = 6; c < 9; ++c)
        sum += std::pow(trace.channel[c][k] - log.measured[c][k], 2);
    }
    return std::sqrt(sum / static_cast<double>(log.rows()));
  }
  const Log& Window(const std::string& trial, const std::string& condition) const {
    for (const Log& log : experiment_.logs) {
      if (log.trial == trial && log.condition == condition) return log;
    }
    throw Error::Input("experiment.yaml", "a window " + trial + " of " + condition, "none");
  }
};

// 0.5 mm: the last digit of the table, and other compilers.
TEST_F(Trunk, ReplaysAsItsReadmeSays) {
  EXPECT_NEAR(TipError(Window("c", "unloaded")), 0.0118, 5e-4);
  EXPECT_NEAR(TipError(Window("c", "loaded")), 0.0146, 5e-4);
}

TEST_F(Trunk, HangsStraightWhereItsRestingDisksWereMeasured) {
  const ModelSpec system = ModelSpec::Load(experiment_.model);
  ModelAndData machine = system.Build();
  mj_forward(machine.model.get(), machine.data.get());
  // Where the disks stand on average while the motors are near zero [m]; 5 mm: hysteresis.
  constexpr double kRest[9] = {0.101,  -0.1045, 0.105,   0.102, -0.197,
                               0.1115, 0.100,   -0.3105, 0.1095};
  for (int c = 0; c < 9; ++c)
    EXPECT_NEAR(machine.data->sensordata[c], kRest[c], 5e-3) << "channel " << c;
}

}  // namespace
}  // namespace continuum
