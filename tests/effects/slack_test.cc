#include "effects/slack.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

TEST(Slack, IsWoundUpBeforeTheCablePulls) {
  const double k = 2000, length = 4e-3;
  const auto tension = [&](double e) {
    return Slack::Eval<double>(Pull<double>{k * e, k}, {length});
  };
  EXPECT_EQ(tension(1e-3), 0);
  EXPECT_EQ(tension(4e-3), 0);
  EXPECT_DOUBLE_EQ(tension(6e-3), k * 2e-3);
}

TEST(Slack, LeavesAGivenForceAndAPushAlone) {
  EXPECT_EQ(Slack::Eval<double>(Pull<double>{7, 0}, {1e-3}), 7);
  EXPECT_EQ(Slack::Eval<double>(Pull<double>{-7, 1e3}, {1e-3}), -7);
}

}  // namespace
}  // namespace continuum
