#include "models/twin_pivot/reach.h"

#include <gtest/gtest.h>

#include "models/twin_pivot/bench.h"

namespace continuum::twin_pivot {
namespace {

// Y and Z of tips along a pull (X follows from the bend), each from the state of the one before:
// the tensions found lead there.
TEST(TwinPivotReach, FollowsAPathWithFrictionByHistory) {
  const Robot robot = Prototype("a");
  Load load = Pull({3, 3, 1, 1});
  Solution made = Solve(robot, load), found = made;
  Load made_by = load, found_by = load;
  for (int row = 1; row <= 4; ++row) {
    Load next = load;
    next.tension = {3 + 0.5 * row, 3, 1, 1 + 0.3 * row};
    made = SolveFrom(robot, made_by, made, next);
    made_by = next;
    const statics::Target target{"", {16, 17}, made.tip.tail<2>()};
    const Load earlier = found_by;
    const Solution at = found;
    const Before before{earlier, at};
    const auto reached = Reach(robot, found_by, Method::kVirtualWork, target, &before);
    ASSERT_TRUE(reached.outcome.ok()) << row << ": " << reached.outcome.why;
    EXPECT_GE(reached.drives.minCoeff(), 0);
    found_by.tension.assign(reached.drives.begin(), reached.drives.end());
    found = SolveFrom(robot, earlier, at, found_by);
    EXPECT_LT((found.tip - made.tip).tail<2>().norm(), 1e-7) << row;
  }
}

// Of all tensions that lead to a tip those found have the least squares: none nearby has less.
TEST(TwinPivotReach, TakesTheLeastTensions) {
  const Robot robot = Prototype("a");
  const Load load = Pull({6, 5, 2, 3}, Condition::kI);
  const Solution s = Solve(robot, load);
  const statics::Target target{"", {15, 16, 17}, s.tip};
  const auto reached = Reach(robot, load, Method::kVirtualWork, target, nullptr);
  ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
  EXPECT_LT(reached.drives.norm(), VectorXd::Map(load.tension.data(), 4).norm());
  statics::Target stiffer = target;
  stiffer.low = 2;
  const auto taut = Reach(robot, load, Method::kVirtualWork, stiffer, nullptr);
  ASSERT_TRUE(taut.outcome.ok()) << taut.outcome.why;
  EXPECT_GE(taut.drives.minCoeff(), 2 - 1e-12);
  EXPECT_GT(taut.drives.norm(), reached.drives.norm());
}

}  // namespace
}  // namespace continuum::twin_pivot
