#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/report/model_changes.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string InWords(double w, double zeta) {
  Hypothesis h{"pt2", "", "actuator valve", ModelSpec::Parse("<mujoco/>"), {}, {}, "", {}};
  for (const char* name : {"w", "zeta"}) {
    h.extra.emplace_back().name = name;
    h.null.push_back(std::numeric_limits<double>::quiet_NaN());
    h.extra.back().upper = 1e6;
  }
  Fitted fitted;
  fitted.fit.x = Eigen::Vector2d(w, zeta);
  return ValuesInWords(h, fitted, 0);
}

TEST(LagsInWords, OfAnOverdampedLagIsOneOfFirstOrderOrTwo) {
  EXPECT_THAT(InWords(500, 4.58), HasSubstr("as a first-order lag of 0.0181 s"));
  // (0.02 s + 1)(0.03 s + 1)
  EXPECT_THAT(InWords(1 / std::sqrt(6e-4), 0.05 / 2 / std::sqrt(6e-4)),
              HasSubstr("as lags of 0.03 and 0.02 s one after the other"));
  EXPECT_THAT(InWords(60, 0.7), Not(HasSubstr("lag")));
}

}  // namespace
}  // namespace continuum
