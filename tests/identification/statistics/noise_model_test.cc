#include "identification/statistics/noise_model.h"

#include <cmath>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/statistics/whitening.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::ArNoise;
using testing::Bench;
using testing::Command;
using testing::Pendulum;

std::vector<std::vector<double>> Samples(int count, std::size_t rows, double rho, double offset) {
  std::vector<std::vector<double>> all;
  for (int i = 0; i < count; ++i) {
    ArNoise noise(2, rho, static_cast<unsigned>(i + 1));
    std::vector<double> y(rows);
    for (double& v : y) v = noise.Next() + (i % 2 ? offset : -offset);
    all.push_back(std::move(y));
  }
  return all;
}

// Six samples of 2000: the variance is known to about 3 % (white), its correlation to 1 %.
TEST(ChannelNoise, WhiteNoiseIsWhite) {
  const ChannelNoise n = NoiseFrom(Samples(6, 2000, 0, 0));
  EXPECT_TRUE(n.ar.empty());
  EXPECT_NEAR(n.rms, 2, 0.06);
  EXPECT_EQ(n.offset, 0);
}

TEST(ChannelNoise, SlowNoiseKeepsItsTime) {
  const ChannelNoise n = NoiseFrom(Samples(6, 2000, 0.95, 0));
  ASSERT_FALSE(n.ar.empty());
  EXPECT_NEAR(std::accumulate(n.ar.begin(), n.ar.end(), 0.0), 0.95, 0.02);
  EXPECT_NEAR(n.innovation, 2 * std::sqrt(1 - 0.95 * 0.95), 0.03);
  EXPECT_EQ(n.offset, 0);
}

TEST(ChannelNoise, OffsetsOfLogsAreNotPartOfIt) {
  const ChannelNoise n = NoiseFrom(Samples(6, 2000, 0, 1));
  EXPECT_NEAR(n.rms, 2, 0.06);
  EXPECT_GE(n.offset, 0.95);  // six samples bound it by a factor of 1.65
  EXPECT_LE(n.offset, 1.75);
}

class Whitened : public Bench {
 protected:
  Experiment Logs(double rho, double quantum) {
    const auto u = Command(0, 1500);
    const auto q = Pendulum().Run(u, testing::kPeriod);
    for (int i = 0; i < 4; ++i) {
      auto y = testing::Noisy(q, 2e-3, rho, static_cast<unsigned>(i + 1));
      for (double& v : y) {
        if (quantum > 0) v = quantum * std::round(v / quantum);
      }
      AddLog("r" + std::to_string(i), "trial: one, use: train", u, y);
    }
    Write("model.xml", Pendulum().Xml());
    return ReadExperiment("");
  }
};

TEST_F(Whitened, ResidualsOfSlowNoiseAreWhiteAndOfSizeOne) {
  const Experiment e = Logs(0.9, 0);
  const ModelSpec system = ModelSpec::Load(folder_ / "model.xml");
  const Problem problem(e, system);
  const Noise noise = NoiseOf(e);
  ASSERT_TRUE(noise.known());
  EXPECT_EQ(noise.source, "replicates");
  const Whitening white(problem, noise);
  const auto z =
      white.Stack(problem.Residuals(problem.Start(), problem.AllLogs()), problem.AllLogs());
  const double n = static_cast<double>(z.size());
  EXPECT_NEAR(z.squaredNorm() / n, 1, 0.1);
  EXPECT_NEAR(z.head(z.size() - 1).dot(z.tail(z.size() - 1)) / z.squaredNorm(), 0, 0.05);
}

TEST_F(Whitened, StepsOfTheMeasurementCountAsNoise) {
  const Noise noise = NoiseOf(Logs(0, 0.02));
  EXPECT_NEAR(noise.channel[0].quantum, 0.02, 1e-12);
  EXPECT_GE(noise.channel[0].rms, 0.02 / std::sqrt(12.0) * 0.99);
  EXPECT_GT(noise.channel[0].offset, 0);
}

TEST_F(Whitened, OneLogOfAMotionTellsWhiteNoiseByItsRowsButOneOfPosesDoesNot) {
  Experiment one = Logs(0, 0);
  one.logs.resize(1);
  EXPECT_EQ(NoiseOf(one).source, "differences");
  EXPECT_GT(NoiseOf(one).rms, 0);
  one.quasi_static = true;
  EXPECT_EQ(NoiseOf(one).source, "not known");
  EXPECT_EQ(NoiseOf(one).rms, 0);
}

// Loggers of 10 ms whose rows come up to 2 ms early or late, each 4 ms later than the one before.
TEST_F(Whitened, ReplicatesOfOtherClocksAreBroughtOntoOneGrid) {
  Experiment e = Logs(0, 0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-2e-3, 2e-3);
  std::normal_distribution<double> noise(0, 2e-3);
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    Log& log = e.logs[l];
    for (std::size_t k = 1; k < log.rows(); ++k) log.time[k] += jitter(random);
    for (std::size_t k = 0; k < log.rows(); ++k) {
      const double t = log.time[k] + 4e-3 * static_cast<double>(l);
      log.measured[0][k] = std::sin(5 * t) + noise(random);
      for (auto& u : log.input) u[k] = std::round(std::sin(t));
    }
  }
  const Noise found = NoiseOf(e);
  EXPECT_EQ(found.source, "replicates");
  EXPECT_EQ(found.resampled, e.logs.size() - 1);
  EXPECT_NEAR(found.channel[0].rms, 2e-3, 1e-4);
  std::fill_n(e.logs[1].input[0].begin() + 100, 200, 5.0);  // another motion
  EXPECT_EQ(NoiseOf(e).resampled, e.logs.size() - 2);
}

// A ramp through many steps: errors are uniform in ±q/2 and repeat with the steps; a value at rest
// keeps its error.
TEST(ChannelNoise, RoundingErrorsOfASlowMotionAreSlow) {
  ChannelNoise n;
  n.quantum = 0.1, n.before = 0.001;
  std::vector<std::vector<double>> values(4, std::vector<double>(1000));
  for (std::size_t l = 0; l < values.size(); ++l) {
    for (std::size_t k = 0; k < 1000; ++k)
      values[l][k] = std::sin(0.004 * static_cast<double>(k + 100 * l));
  }
  const ChannelNoise found = RoundingNoise(n, values);
  EXPECT_NEAR(found.rms, 0.1 / std::sqrt(12.0), 0.003);
  ASSERT_FALSE(found.ar.empty());
  EXPECT_GT(found.ar[0], 0.7);
}

}  // namespace
}  // namespace continuum
