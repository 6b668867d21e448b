#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.h"

namespace continuum {
namespace {

using namespace testing;  // the bench
using ::testing::HasSubstr;

// Swings of 0.4 rad, one of which is asked to be larger.
Log SwingsWithOneOf(double amplitude) {
  Recipe recipe;
  recipe.u1 = [=](double t) {
    const bool once = t > std::numbers::pi && t < 1.5 * std::numbers::pi;
    return (once ? amplitude : 0.4) * std::sin(2 * t);
  };
  return Record(recipe);
}

TEST(Stop, IsToldWhereTheCommandGoesOnBeyondIt) {
  Log log = SwingsWithOneOf(1);
  std::size_t k = 0;
  for (double& q : Column(log, "q1"))
    q = std::min(q, 0.6 + 0.002 * std::sin(1.7 * static_cast<double>(k++)));  // a stop that gives
  const auto all = CheckLogs(With(log));
  const Finding* const f = Find(all, "stop", "q1");
  ASSERT_NE(f, nullptr) << Report(all);
  EXPECT_THAT(f->text, HasSubstr("largest value 0.6"));
  EXPECT_THAT(f->text, HasSubstr("input 'u1' goes up to 0.39"));
  EXPECT_EQ(f->severity, Finding::Severity::kWarning);
}

TEST(Stop, IsNotSeenInAJointThatFollows) {
  for (const double amplitude : {0.4, 1.0}) {
    const auto all = CheckLogs(With(SwingsWithOneOf(amplitude)));
    EXPECT_EQ(Find(all, "stop", "q1"), nullptr) << Report(all);
  }
}

// Dry friction leaves a joint behind its command by as much wherever it turns.
TEST(Stop, IsNotSeenInAJointThatIsHeldWhereverItTurns) {
  Log log = SwingsWithOneOf(0.6);
  double at = 0;
  for (double& q : Column(log, "q1")) q = at = std::clamp(at, q - 0.15, q + 0.15);
  const auto all = CheckLogs(With(log));
  EXPECT_EQ(Find(all, "stop", "q1"), nullptr) << Report(all);
}

}  // namespace
}  // namespace continuum
