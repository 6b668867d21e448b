#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/score.h"
#include "sim/simulate.h"
#include "sim/system.h"
#include "support/real_log.h"

namespace continuum {
namespace {

class StiffFlopRecording : public testing::RealLog {
 protected:
  void SetUp() override { Import("stiff_flop"); }

  struct Errors {
    double tip, turn;  // mean distance [m] and mean angle [rad]
  };
  Errors Replay(bool train, const std::vector<Change>& changes = {}) const {
    const System system = System::Load(experiment_.model);
    Errors sum{0, 0};
    double rows = 0;
    for (const Log& log : experiment_.logs) {
      if (log.train != train) continue;
      std::vector<Change> all = log.set;
      all.insert(all.end(), changes.begin(), changes.end());
      Machine machine = system.Build(all);
      const auto left = Residuals(experiment_, log, Simulate(machine, experiment_, log));
      for (std::size_t k = 0; k < log.rows(); ++k) {
        if (std::isnan(left[0][k])) continue;
        sum.tip += std::hypot(left[0][k], left[1][k], left[2][k]);
        sum.turn += std::hypot(left[3][k], left[4][k], left[5][k]);
        ++rows;
      }
    }
    return {sum.tip / rows, sum.turn / rows};
  }
};

TEST_F(StiffFlopRecording, GivesThreeCyclesOfThreeLines) {
  ASSERT_EQ(experiment_.logs.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    const Log& log = experiment_.logs[i];
    EXPECT_EQ(log.trial, "line" + std::to_string(i % 3 + 1) + "_cycle" + std::to_string(i / 3 + 1));
    EXPECT_EQ(log.train, i < 6);
  }
}

}  // namespace
}  // namespace continuum
