#include "sim/io/rounded.h"

#include <limits>

#include <gtest/gtest.h>

namespace continuum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Rounded, WhatRoundsToZeroFromBelowHasNoSign) {
  EXPECT_EQ(Fixed(-0.3, 0), "0");
  EXPECT_EQ(Fixed(-0.0004, 2), "0.00");
  EXPECT_EQ(Significant(-0.0, 3), "0");
  EXPECT_EQ(Percent(-0.0049), "0 %");
  EXPECT_EQ(Percent(-0.0003, 1), "0.0 %");
}

TEST(Rounded, OtherNumbersKeepTheirs) {
  EXPECT_EQ(Fixed(-0.5001, 0), "-1");
  EXPECT_EQ(Fixed(-0.06, 1), "-0.1");
  EXPECT_EQ(Significant(-1e-9, 3), "-1e-09");
  EXPECT_EQ(Percent(-0.0643, 1), "-6.4 %");
  EXPECT_EQ(Percent(0.643), "64 %");
  EXPECT_EQ(Fixed(-kInfinity, 1), "-inf");
}

}  // namespace
}  // namespace continuum
