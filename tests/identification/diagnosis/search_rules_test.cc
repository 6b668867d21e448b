#include "identification/diagnosis/search_rules.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace continuum {
namespace {

// Chi squared at two and at four degrees of freedom: exp(−x/2) and (1 + x/2) exp(−x/2).
TEST(ChanceOfGain, IsTheTailOfChiSquaredOfAllFitsTogether) {
  EXPECT_DOUBLE_EQ(ChanceOfGain(20, 2, 1), std::exp(-10));
  EXPECT_DOUBLE_EQ(ChanceOfGain(20, 4, 1), 11 * std::exp(-10));
  EXPECT_DOUBLE_EQ(ChanceOfGain(20, 2, 30), 30 * std::exp(-10));
}

TEST(ChanceOfGain, IsNeverTooSmallForAnOddNumber) {
  EXPECT_GT(ChanceOfGain(9, 1, 1), std::erfc(std::sqrt(4.5)));  // of one degree of freedom
}

TEST(ChanceOfGain, IsOneWithoutAGain) {
  EXPECT_EQ(ChanceOfGain(0, 1, 1), 1);
  EXPECT_EQ(ChanceOfGain(-3, 2, 10), 1);
  EXPECT_EQ(ChanceOfGain(1, 1, 100), 1);
}

// Noise of 3 and a step of 4 make 5.
// A tilt of gravity beside a sideways swing: its slope is that of the cosine, next to nothing where
// the fit ended, so that first order goes 20 times as far and promises 690 squares.
TEST(SearchRules, WhatNoSimulationKeepsIsNoGain) {
  EXPECT_DOUBLE_EQ(GainKept(690, -240, -1e5), -240);
  EXPECT_DOUBLE_EQ(GainKept(690, 100, 680), 690);  // kept where first order has its least
  EXPECT_DOUBLE_EQ(GainKept(690, 600, -1e5), 690);
  EXPECT_DOUBLE_EQ(GainKept(690, 20, std::numeric_limits<double>::quiet_NaN()), 20);
}

TEST(SearchRules, NothingShowsBelowNoiseAndTimeStepTogether) {
  EXPECT_TRUE(IsWithinNoise(4.99, {3, 4}));
  EXPECT_FALSE(IsWithinNoise(5.01, {3, 4}));
}

// Friction that differs by direction may be friction and an offset; what leaves only noise is not
// looked at, nor what is plain.
TEST(SearchRules, RichLawThatLeavesMoreThanNoiseMayBeTwoPlainOnes) {
  Verdict named{Verdict::Kind::kNamed};
  EXPECT_TRUE(MayBeTwoPlainer(named, true, 1.2));
  EXPECT_FALSE(MayBeTwoPlainer(named, false, 1.2));
  EXPECT_FALSE(MayBeTwoPlainer(named, true, 1.05));
  named.complete = true;
  EXPECT_FALSE(MayBeTwoPlainer(named, true, 1.2));
}

}  // namespace
}  // namespace continuum
