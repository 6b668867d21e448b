#include "identification/study/random_effects.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "error.h"

namespace continuum {
namespace {

// Log risk ratios of thirteen trials of a vaccine: G. A. Colditz et al., JAMA 271 (1994) 698. Cases
// and others, treated and not, as in the data set dat.bcg of the R package metafor.
std::vector<UnitValue> Vaccine() {
  constexpr double kTrials[][4] = {
      {4, 119, 11, 128},       {6, 300, 29, 274},        {3, 228, 11, 209},
      {62, 13536, 248, 12619}, {33, 5036, 47, 5761},     {180, 1361, 372, 1079},
      {8, 2537, 10, 619},      {505, 87886, 499, 87892}, {29, 7470, 45, 7232},
      {17, 1699, 65, 1600},    {186, 50448, 141, 27197}, {5, 2493, 3, 2338},
      {27, 16886, 29, 17825}};
  std::vector<UnitValue> units;
  for (const auto& [a, b, c, d] : kTrials) {
    const double ratio = std::log(a / (a + b) / (c / (c + d)));
    units.push_back({ratio, std::sqrt(1 / a - 1 / (a + b) + 1 / c - 1 / (c + d))});
  }
  return units;
}

// As metafor gives them: rma(yi, vi, data = dat.bcg, method = "PM") and confint, to four digits.
TEST(RandomEffects, AreThoseOfAPublishedDataSet) {
  const RandomEffects r = FitRandomEffects(Vaccine());
  EXPECT_NEAR(r.between * r.between, 0.3181, 5e-5);
  EXPECT_NEAR(r.between_low * r.between_low, 0.1197, 5e-5);
  EXPECT_NEAR(r.between_high * r.between_high, 1.1115, 5e-5);
  EXPECT_NEAR(r.mean, -0.7150, 5e-5);
  EXPECT_LT(r.p, 1e-4);
}

TEST(RandomEffects, OfUnitsThatAgreeHaveNoSpread) {
  const RandomEffects r = FitRandomEffects({{1, 0.1}, {1.01, 0.1}, {0.99, 0.1}});
  EXPECT_EQ(r.between, 0);
  EXPECT_EQ(r.between_low, 0);
  EXPECT_NEAR(r.mean, 1, 1e-12);
  EXPECT_GT(r.p, 0.5);
  // Student's t of two degrees of freedom times 0.1/sqrt(3): not narrower than the units' own.
  EXPECT_NEAR(r.mean_high - r.mean, 4.3027 * 0.1 / std::sqrt(3.0), 1e-4);
}

TEST(RandomEffects, RefuseWhatHasNoInterval) {
  EXPECT_THROW(FitRandomEffects({{1, 0.1}}), Error);
  EXPECT_THROW(FitRandomEffects({{1, 0.1}, {2, 0}}), Error);
  EXPECT_THROW(FitRandomEffects({{1, 0.1}, {NAN, 1}}), Error);
  EXPECT_THROW(DeviationsOf({{1, 0.1}, {2, 0.1}}), Error);
}

// Forty units of mean 5 and spread 0.4, known to 0.1 to 0.3.
std::vector<UnitValue> Drawn(std::mt19937& random, std::size_t count) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> error(0.1, 0.3);
  std::vector<UnitValue> units;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = error(random);
    units.push_back({5 + 0.4 * normal(random) + s * normal(random), s});
  }
  return units;
}

// 95 % of 1000 draws: within 3 standard deviations, 0.7 % each. Three units often show no spread
// where there is one; their interval of the mean is then as wide as the units' own, and too wide.
TEST(RandomEffects, IntervalsContainTheTruthInNineteenOfTwentyDraws) {
  std::mt19937 random(1);
  for (const std::size_t count : {3, 10, 40}) {
    int mean = 0, between = 0, alarms = 0;
    for (int draw = 0; draw < 1000; ++draw) {
      const auto units = Drawn(random, count);
      const RandomEffects r = FitRandomEffects(units);
      mean += r.mean_low < 5 && 5 < r.mean_high;
      between += r.between_low < 0.4 && 0.4 < r.between_high;
      for (const UnitDeviation& d : DeviationsOf(units)) alarms += d.odd;
    }
    EXPECT_GT(mean / 1000.0, 0.95 - 0.021) << count;
    EXPECT_LT(mean / 1000.0, count == 3 ? 0.99 : 0.95 + 0.021) << count;
    EXPECT_NEAR(between / 1000.0, 0.95, 0.021) << count;
    EXPECT_LT(alarms / 1000.0, 0.05 + 0.021) << count;
  }
}

TEST(RandomEffects, TheOddOneOfFortyIsFound) {
  std::mt19937 random(2);
  int found = 0, others = 0;
  for (int draw = 0; draw < 100; ++draw) {
    auto units = Drawn(random, 40);
    units[17].value = 5 + 5 * 0.4;  // five spreads off
    const auto all = DeviationsOf(units);
    for (std::size_t i = 0; i < all.size(); ++i) (i == 17 ? found : others) += all[i].odd;
  }
  EXPECT_GE(found, 90);
  EXPECT_LE(others, 10);
}

}  // namespace
}  // namespace continuum
