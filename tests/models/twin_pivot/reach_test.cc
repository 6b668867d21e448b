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

// With stretch and pretension, and without both, where some cables are slack. The lengths alone
// lead there again.
TEST(TwinPivotReach, FindsLengthsThatLeadToATip) {
  for (const double EA : {3e3, 0.0}) {
    SCOPED_TRACE(EA);
    Robot robot = Prototype("a");
    robot.cable_EA = EA;
    const double low = EA > 0 ? 1 : 0;
    const Solution made = Solve(robot, Pull({6, 5, low, low}));
    Load load = Pull({0, 0, 0, 0});
    load.length = VectorXd::Constant(4, 6 * robot.L[0] * 1.02);
    const statics::Target target{"", {16, 17}, made.tip.tail<2>(), low};
    const auto reached = ReachByLengths(robot, load, Method::kVirtualWork, target, nullptr);
    ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
    load.length = reached.drives;
    const Solution wound = Solve(robot, load);
    ASSERT_TRUE(wound.outcome.ok()) << wound.outcome.why;
    EXPECT_LT((wound.tip - made.tip).tail<2>().norm(), 1e-6 * robot.Length());
    EXPECT_GE(wound.pull.minCoeff(), 0.95 * low);
    EXPECT_LT(wound.pull.norm(), 1.05 * std::sqrt(36 + 25 + 2 * low));
  }
  const statics::Target taut{"", {16, 17}, VectorXd::Zero(2), 1};
  Load load = Pull({0, 0, 0, 0});
  load.length = VectorXd::Constant(4, 0.04);
  const auto none = ReachByLengths(Prototype("a"), load, Method::kVirtualWork, taut, nullptr);
  EXPECT_NE(none.outcome.why.find("do not stretch"), std::string::npos);
}

}  // namespace
}  // namespace continuum::twin_pivot
