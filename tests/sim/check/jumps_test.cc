#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/check/check.h"

namespace continuum {
namespace {

// Two position channels of 1000 rows: one moves with 1 mm of noise, one hardly, and twice by 2 mm.
std::vector<Finding> JumpsOf(const std::string& moving, const std::string& quiet) {
  Experiment e;
  for (const std::string& source : {moving, quiet}) {
    Output out;
    out.columns = {source};
    out.unit = "m";
    out.source = source;
    e.channels.push_back({source, "m", e.outputs.size(), 0, 1});
    e.outputs.push_back(out);
  }
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  Log log;
  log.label = log.trial = "log";
  log.measured.resize(2);
  for (int k = 0; k < 1000; ++k) {
    log.time.push_back(0.01 * k);
    log.measured[0].push_back(std::sin(0.02 * k) + 1e-3 * noise(random));
    log.measured[1].push_back(1e-5 * noise(random) + (k == 300 || k == 700 ? 2e-3 : 0));
  }
  e.logs.push_back(log);
  std::vector<Finding> jumps;
  for (const Finding& f : CheckLogs(e)) {
    if (f.what == "jump") jumps.push_back(f);
  }
  return jumps;
}

TEST(CheckJump, FarBeyondTheNoiseOfAQuietSensorIsNamed) {
  const auto jumps = JumpsOf("near", "far");
  ASSERT_EQ(jumps.size(), 1u);
  EXPECT_EQ(jumps[0].channel, "far");
}

TEST(CheckJump, BelowTheNoiseThatTheSensorHasInAnotherDirectionIsNone) {
  EXPECT_TRUE(JumpsOf("tip[0]", "tip[1]").empty());
}

}  // namespace
}  // namespace continuum
