#include "sim/simulation/score.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

namespace continuum {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsNan;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
// Sums of a few numbers of order one.
constexpr double kRounding = 1e-14;

void AddOutput(Experiment& e, const std::vector<std::string>& columns, const std::string& unit,
               double factor) {
  Output out;
  out.columns = columns;
  out.unit = unit;
  for (std::size_t c = 0; c < columns.size(); ++c)
    e.channels.push_back({columns[c], unit, e.outputs.size(), c, factor});
  e.outputs.push_back(out);
}

Log Rows(std::vector<std::vector<double>> measured) {
  Log log;
  for (std::size_t k = 0; k < measured.front().size(); ++k)
    log.time.push_back(0.1 * static_cast<double>(k));
  log.measured = std::move(measured);
  return log;
}

TEST(Score, GivesErrorsInTheUnitOfTheChannel) {
  Experiment e;
  AddOutput(e, {"x"}, "mm", 1e-3);
  const Log log = Rows({{0.001, 0.003, kNan, 0.001, 0.003}});
  const Trace trace{{{0.002, 0.003, 9, 0.001, 0.000}}};
  const auto score = ScoreLog(e, log, trace);
  ASSERT_EQ(score.size(), 1u);
  EXPECT_EQ(score[0].rows, 4u);
  EXPECT_NEAR(score[0].rmse, std::sqrt((1 + 9) / 4.), kRounding);
  EXPECT_NEAR(score[0].mae, 1, kRounding);
  EXPECT_NEAR(score[0].nrmse, std::sqrt(2.5), kRounding);  // the std of 1, 3, 1, 3 is 1
  EXPECT_NEAR(score[0].fit, 100 * (1 - std::sqrt(2.5)), 1e-12);
  EXPECT_NEAR(score[0].largest, -3, kRounding);
  EXPECT_DOUBLE_EQ(score[0].when, 0.4);
}

TEST(Score, StaysFiniteForAConstantChannel) {
  Experiment e;
  AddOutput(e, {"x"}, "1", 1);
  const auto score = ScoreLog(e, Rows({{1, 1}}), {{{2, 2}}});
  EXPECT_TRUE(std::isfinite(score[0].nrmse) && std::isfinite(score[0].fit));
}

// The sum of 0.1 over such rows is no multiple of it: rounding must not pass for the channel's
// size.
TEST(Score, PoolsAConstantChannelInItsOwnUnitBesideOthers) {
  Experiment e;
  AddOutput(e, {"x"}, "rad", 1);
  AddOutput(e, {"y"}, "mm", 1e-3);
  e.logs = {Rows({{1, 2, 1, 2, 1, 2, 1}, std::vector<double>(7, 0.1)})};
  const Pool pool(e);
  EXPECT_EQ(pool.unit(), "std");
  EXPECT_EQ(pool.scale(1), 1e-3);
}

// Rows of a simulation that has diverged are no rows without a measurement.
TEST(Score, IsInfiniteWhereTheSimulationGivesNoNumber) {
  Experiment e;
  AddOutput(e, {"x"}, "m", 1);
  const Log log = Rows({{0, kNan, 2, 3}});
  const Trace trace{{{0, kNan, kNan, 3}}};
  const auto r = Residuals(e, log, trace);
  EXPECT_THAT(r[0], ElementsAre(0, IsNan(), kInf, 0));
  const auto score = ScoreLog(e, log, trace);
  EXPECT_EQ(score[0].rows, 3u);
  EXPECT_EQ(score[0].rmse, kInf);
  EXPECT_EQ(score[0].mae, kInf);
  EXPECT_DOUBLE_EQ(score[0].when, 0.2);
  Pool::Sum sum;
  Pool(e).Add(r, sum);
  EXPECT_EQ(sum.Rms(), kInf);
}

class Turn : public ::testing::Test {
 protected:
  Turn() { AddOutput(e_, {"qw", "qx", "qy", "qz"}, "1", 1); }
  static std::vector<std::vector<double>> About(const std::vector<double>& axis, double angle,
                                                double factor) {
    double quat[4];
    mju_axisAngle2Quat(quat, axis.data(), angle);
    std::vector<std::vector<double>> q;
    for (const double c : quat) q.push_back({factor * c, factor * c});
    return q;
  }
  Experiment e_;
};

TEST_F(Turn, OfADivergedSimulationIsInfinite) {
  const auto r = Residuals(e_, Rows(About({0, 1, 0}, 0.2, 1)),
                           {std::vector<std::vector<double>>(4, {kNan, kNan})});
  EXPECT_THAT(r[1], ElementsAre(kInf, kInf));
}

// It turns the measured orientation into the simulated one: simulated minus measured, as for every
// other channel.
TEST_F(Turn, IsARotationVectorWhateverSignAndLengthTheMeasuredQuaternionHas) {
  const Trace trace{About({0, 1, 0}, 0.3, 1)};
  for (const double factor : {1., -1., 0.99}) {
    const auto r = Residuals(e_, Rows(About({0, 1, 0}, 0.2, factor)), trace);
    EXPECT_NEAR(r[0][0], 0, 1e-12);
    EXPECT_NEAR(r[1][0], 0.1, 1e-12);
    EXPECT_NEAR(r[2][0], 0, 1e-12);
    EXPECT_EQ(r[3][0], 0);
  }
}

TEST_F(Turn, TakesTheShortWayRoundAcrossHalfATurn) {
  const auto r = Residuals(e_, Rows(About({0, 0, 1}, 3.1, 1)), {About({0, 0, 1}, -3.1, 1)});
  EXPECT_NEAR(r[2][0], 2 * mjPI - 6.2, 1e-12);
}

TEST_F(Turn, OfALostSampleLeavesTheScoreFinite) {
  const Trace trace{About({0, 1, 0}, 0.3, 1)};
  for (const auto& lost : {std::vector<double>{kNan, 0, 1, 0}, std::vector<double>{0, 0, 0, 0}}) {
    Log log = Rows(About({0, 1, 0}, 0.2, 1));
    for (std::size_t c = 0; c < 4; ++c) log.measured[c][1] = lost[c];
    for (const ChannelScore& s : ScoreLog(e_, log, trace)) {
      EXPECT_TRUE(std::isfinite(s.rmse) && std::isfinite(s.mae) && std::isfinite(s.largest))
          << s.channel << " with w = " << lost[0];
      EXPECT_EQ(s.rows, 1u) << s.channel << " with w = " << lost[0];
    }
  }
}

TEST_F(Turn, CountsThreeNumbersInThePool) {
  const Log log = Rows(About({0, 1, 0}, 0.2, 1));
  Pool::Sum sum;
  Pool(e_).Add(Residuals(e_, log, {About({0, 1, 0}, 0.5, 1)}), sum);
  EXPECT_NEAR(sum.Rms(), 0.3 / std::sqrt(3), 1e-12);
}

TEST(Pool, MixesUnitsByTheStandardDeviationOfTheTrainRows) {
  Experiment e;
  AddOutput(e, {"x"}, "mm", 1e-3);
  AddOutput(e, {"q"}, "rad", 1);
  e.logs = {Rows({{0, 0.002}, {0, 4}}), Rows({{0, 100}, {0, 100}})};
  e.logs[1].train = false;
  const Pool pool(e);
  EXPECT_EQ(pool.unit(), "std");
  Pool::Sum sum;
  pool.Add({{0.003, kNan}, {2, 0}}, sum);
  EXPECT_NEAR(sum.Rms(), std::sqrt((9. + 1 + 0) / 3), kRounding);
}

// Not by those of the quaternion's numbers, of which each half tells of another axis.
TEST_F(Turn, IsPooledByTheTurnsFromTheMeanOrientation) {
  AddOutput(e_, {"x"}, "mm", 1e-3);
  const auto here = About({0, 1, 0}, 0.2, 1), there = About({0, 1, 0}, -0.2, 1);
  std::vector<std::vector<double>> measured;
  for (std::size_t c = 0; c < 4; ++c) measured.push_back({here[c][0], -there[c][0]});
  measured.push_back({0, 0.002});
  e_.logs = {Rows(measured)};
  const Pool pool(e_);
  for (const std::size_t component : {0, 1, 2})
    EXPECT_NEAR(pool.scale(component), 0.2 / std::sqrt(3), 1e-12);
}

TEST(Pool, KeepsACommonUnitAndLeavesUnscoredChannelsOut) {
  Experiment e;
  AddOutput(e, {"x"}, "mm", 1e-3);
  AddOutput(e, {"v"}, "m/s", 1);
  e.outputs[1].weight = 0;
  e.logs = {Rows({{0, 1}, {0, 1}})};
  const Pool pool(e);
  EXPECT_EQ(pool.unit(), "mm");
  Pool::Sum sum;
  EXPECT_EQ(sum.Rms(), 0);
  pool.Add({{0.003, 0.003}, {1e6, 1e6}}, sum);
  EXPECT_NEAR(sum.Rms(), 3, kRounding);
}

}  // namespace
}  // namespace continuum
