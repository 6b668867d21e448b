#include <gtest/gtest.h>

#include <cmath>

#include "models/statics/slide.h"
#include "models/twin_pivot/bench.h"

namespace continuum::twin_pivot {
namespace {

using statics::SlideFrom;

const std::vector<double> kPulled{19.62, 19.62, 9.81, 9.81};

// From tensions `from` to `to` in equal rows, each from the state of the row before.
Solution InRows(const Robot& robot, const std::vector<double>& from, const std::vector<double>& to,
                int rows, const Solution* before = nullptr) {
  Load earlier = Pull(from);
  Solution state = before ? *before : Solution();
  for (int row = 1; row <= rows; ++row) {
    Load load = Pull(to);
    for (std::size_t j = 0; j < to.size(); ++j) {
      load.tension[j] = from[j] + (to[j] - from[j]) * row / rows;
    }
    state =
        row == 1 && before == nullptr ? Solve(robot, load) : SolveFrom(robot, earlier, state, load);
    EXPECT_TRUE(state.outcome.ok()) << row << ": " << state.outcome.why;
    earlier = load;
  }
  return state;
}

TEST(TwinPivotMemory, ContactsGoOnWhereTheyWereLeft) {
  for (const double first : {0., 0.3, 1., -0.7, 40.}) {
    for (const double second : {0., 0.2, 2., 30.}) {
      const double whole = SlideFrom(0, first + (first < 0 ? -second : second));
      const double parts = SlideFrom(SlideFrom(0, first), first < 0 ? -second : second);
      EXPECT_NEAR(parts, whole, 1e-15);
    }
  }
  EXPECT_NEAR(SlideFrom(1, 0.), 1, 1e-15);
  EXPECT_NEAR(SlideFrom(1, -1.), 0, 1e-15);  // a reversal gives way within eps
  EXPECT_NEAR(SlideFrom(1, -2.), -std::tanh(1.), 1e-15);
}

TEST(TwinPivotMemory, HoldingStillMovesNothing) {
  for (const char* name : {"a", "b"}) {
    const Robot robot = Prototype(name);
    const Solution first = Solve(robot, Pull(kPulled));
    Solution state = first;
    for (int row = 0; row < 1000; ++row) {
      state = SolveFrom(robot, Pull(kPulled), state, Pull(kPulled));
      ASSERT_TRUE(state.outcome.ok()) << state.outcome.why;
    }
    EXPECT_LT((state.tip - first.tip).norm(), 1e-9);
  }
}

TEST(TwinPivotMemory, OnePullDoesNotDependOnTheNumberOfRows) {
  const Robot robot = Prototype("b");
  const std::vector<double> rest{9.81, 9.81, 9.81, 9.81};
  const Solution once = Solve(robot, Pull(kPulled));
  for (const int rows : {2, 10, 100}) {
    EXPECT_LT((InRows(robot, rest, kPulled, rows).tip - once.tip).norm(), 1e-6) << rows;
  }
}

// The second section pulls the cables of the first one to and fro within a row.
TEST(TwinPivotMemory, ContactsThatTurnBackWithinARowAreFollowed) {
  const Robot robot = Prototype("c");
  const std::vector<double> low{1.2, 3.1, 2.4, 0.8, 3.6, 1.1, 0.9, 2.7};
  const std::vector<double> high{8.4, 1.6, 3.2, 6.9, 1.3, 7.8, 5.1, 2.2};
  const Solution start = Solve(robot, Pull(low));
  const Solution once = InRows(robot, low, high, 1, &start);
  const Solution parts = InRows(robot, low, high, 400, &start);
  EXPECT_GT(once.parts, 1);
  EXPECT_LT((once.tip - parts.tip).norm(), 1e-6);
}

TEST(TwinPivotMemory, ACycleClosesAHysteresisLoop) {
  const Robot robot = Prototype("b");
  const std::vector<double> low{12, 12, 9.81, 9.81};
  const Solution up = InRows(robot, {9.81, 9.81, 9.81, 9.81}, kPulled, 10);
  const Solution down = InRows(robot, kPulled, low, 10, &up);
  const Solution again = InRows(robot, low, kPulled, 10, &down);
  const Solution back = InRows(robot, kPulled, low, 10, &again);
  const Solution third = InRows(robot, low, kPulled, 10, &back);
  EXPECT_LT((third.tip - again.tip).norm(), 1e-9);
  const Solution rising = InRows(robot, {9.81, 9.81, 9.81, 9.81}, low, 10);
  EXPECT_GT((back.tip - rising.tip).norm(), 1e-3);  // friction keeps it bent
}

}  // namespace
}  // namespace continuum::twin_pivot
