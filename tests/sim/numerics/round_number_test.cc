#include "sim/numerics/round_number.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

TEST(RoundNumber, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(RoundUp(0.013), 0.02);
  EXPECT_DOUBLE_EQ(RoundUp(3), 5);
  EXPECT_DOUBLE_EQ(RoundUp(70), 100);
  EXPECT_DOUBLE_EQ(RoundDown(0.013), 0.01);
  EXPECT_DOUBLE_EQ(RoundDown(3), 2);
  EXPECT_DOUBLE_EQ(RoundDown(70), 50);
}

TEST(RoundNumber, OfAScaleIsAtMostHalfAsMuchAgain) {
  for (double x = 0.011; x < 1000; x *= 1.013) {
    EXPECT_GE(RoundUpClosely(x), x);
    EXPECT_LE(RoundUpClosely(x), 1.5 * x);
  }
  EXPECT_DOUBLE_EQ(RoundUpClosely(40), 40);
  EXPECT_DOUBLE_EQ(RoundUpClosely(20.6), 30);
  EXPECT_EQ(RoundUpClosely(-1), 0);
}

TEST(RoundNumber, StaysWhatIsRound) {
  for (const double x : {1.0, 2.0, 5.0}) {
    EXPECT_DOUBLE_EQ(RoundUp(x), x);
    EXPECT_DOUBLE_EQ(RoundDown(x), x);
  }
}

TEST(RoundNumber, IsNothingForNothing) {
  EXPECT_EQ(RoundUp(0), 0);
  EXPECT_EQ(RoundUp(-3), 0);
}

}  // namespace
}  // namespace continuum
