#include "sim/replay/sensor_score.h"

#include <cmath>

#include <gtest/gtest.h>

namespace continuum {
namespace {

Output Of(std::vector<std::string> columns, const std::string& unit, const std::string& source) {
  Output out;
  out.columns = std::move(columns);
  out.unit = unit;
  out.source = source;
  return out;
}

// A tip [mm] measured in two directions, its turn, and a voltage; the outputs in this order.
class SensorScores : public ::testing::Test {
 protected:
  SensorScores() {
    e_.outputs = {Of({"x"}, "mm", "tip[0]"), Of({"y"}, "mm", "tip[1]"),
                  Of({"qw", "qx", "qy", "qz"}, "1", "turn"), Of({"u"}, "V", "drive")};
    e_.outputs[3].kind = Output::Kind::kForce;
    for (std::size_t o = 0; o < e_.outputs.size(); ++o) {
      const Output& out = e_.outputs[o];
      for (std::size_t c = 0; c < out.columns.size(); ++c)
        e_.channels.push_back({out.columns[c], out.unit, o, c, out.unit == "mm" ? 1e-3 : 1});
    }
  }

  // One row: the tip is off by dx, dy [m], turned by an angle about x [rad], u is 4 V and off by
  // du.
  void Add(bool train, const std::string& condition, double dx, double dy, double turn, double du) {
    Log log;
    log.train = train;
    log.condition = condition;
    log.time = {0};
    log.measured = {{0.03}, {0.04}, {1}, {0}, {0}, {0}, {4}};
    Replayed replayed;
    replayed.trace.channel = {
        {0.03 + dx}, {0.04 + dy}, {std::cos(turn / 2)}, {std::sin(turn / 2)}, {0}, {0}, {4 + du}};
    e_.logs.push_back(log);
    logs_.push_back(replayed);
  }
  SensorScore Find(const std::string& source, const std::string& use,
                   const std::string& condition = "") const {
    for (const SensorScore& s : ScoreSensors(e_, logs_)) {
      if (s.source == source && s.use == use && s.condition == condition) return s;
    }
    ADD_FAILURE() << source << " " << use << " " << condition;
    return {};
  }

  Experiment e_;
  std::vector<Replayed> logs_;
};

TEST_F(SensorScores, AreDistancesAnglesAndSharesOfWhatWasMeasured) {
  Add(true, "", 0.003, 0.004, 0.2, 1);
  const SensorScore tip = Find("tip", "train"), turn = Find("turn", "train");
  EXPECT_NEAR(tip.rms, 5, 1e-12);  // mm
  EXPECT_EQ(tip.unit, "mm");
  EXPECT_NEAR(tip.relative, 0.1, 1e-12);  // of 50 mm
  EXPECT_NEAR(turn.mean, 0.2, 1e-12);
  EXPECT_EQ(turn.unit, "rad");
  EXPECT_EQ(turn.relative, 0);
  EXPECT_NEAR(Find("drive", "train").relative, 0.25, 1e-12);
  EXPECT_EQ(Find("drive", "train").quantity, "force");
}

TEST_F(SensorScores, ArePooledOverTheRowsOfEachUseAndCondition) {
  Add(true, "light", 0.003, 0, 0, 0);
  Add(false, "light", 0.001, 0, 0, 0);
  Add(false, "heavy", 0.007, 0, 0, 0);
  EXPECT_NEAR(Find("tip", "train").rms, 3, 1e-12);
  EXPECT_NEAR(Find("tip", "validate").rms, 5, 1e-12);
  EXPECT_NEAR(Find("tip", "validate").mean, 4, 1e-12);
  EXPECT_NEAR(Find("tip", "validate", "heavy").rms, 7, 1e-12);
  EXPECT_NEAR(Find("tip", "", "light").mean, 2, 1e-12);
  EXPECT_EQ(Find("tip", "").rows, 3u);
}

TEST_F(SensorScores, SkipRowsThatMissAComponentAndSensorsInSeveralUnits) {
  Add(true, "", 0.003, 0, 0, 0);
  Add(true, "", 0.009, 0, 0, 0);
  e_.logs[1].measured[1][0] = NAN;
  EXPECT_EQ(Find("tip", "train").rows, 1u);
  EXPECT_NEAR(Find("tip", "train").rms, 3, 1e-12);
  e_.channels[1].unit = "m";
  for (const SensorScore& s : ScoreSensors(e_, logs_)) EXPECT_NE(s.source, "tip");
}

}  // namespace
}  // namespace continuum
