#include "effects/tendon_stretch.h"

#include <gtest/gtest.h>

namespace continuum {
namespace {

// Servo k in series with a spring 1/c: the common tension of e = T/k + c T.
TEST(TendonStretch, IsASpringInSeriesWithTheServo) {
  const double k = 2000, c = 3e-4, e = 0.01;
  const double T = TendonStretch::Eval<double>(Pull<double>{k * e, k}, {c});
  EXPECT_DOUBLE_EQ(T / k + c * T, e);
}

TEST(TendonStretch, LeavesAGivenForceAndAPushAlone) {
  EXPECT_EQ(TendonStretch::Eval<double>(Pull<double>{7, 0}, {1e-3}), 7);
  EXPECT_EQ(TendonStretch::Eval<double>(Pull<double>{-7, 1e3}, {1e-3}), -7);
}

}  // namespace
}  // namespace continuum
