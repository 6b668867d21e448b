#include <gtest/gtest.h>

#include <cmath>

#include "models/tdcr/disks.h"
#include "models/tdcr/model.h"
#include "models/tdcr/pulled_rows.h"

namespace continuum::tdcr {
namespace {

constexpr Method kMethods[] = {Method::kEas, Method::kPcca};

// The derivatives of the shares too, by differences.
TEST(TdcrMemory, TheTangentIsTheDerivativeOfTheBalance) {
  const Robot robot = Nominal();
  Loads loads = Pull(robot, {3, 1, 2});
  const Solution s = SolveCase(robot, loads, Method::kEas);
  ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
  loads.from = s.contacts;
  loads.from.share *= 0.3;                     // all at rest,
  loads.from.length.row(8).array() -= 0.2e-6;  // beside the kink of a contact that turns back
  const DiskBalance<6> balance(robot, loads);
  DiskBalance<6>::Vector x = s.x, f, up, down;
  DiskBalance<6>::Matrix jacobian;
  ASSERT_TRUE(balance.Jacobian(x, f, jacobian));
  const double h = 1e-7;
  for (int i = 0; i < 6; ++i) {
    DiskBalance<6>::Vector at = x;
    at[i] += h;
    ASSERT_TRUE(balance(at.data(), up.data()));
    at[i] -= 2 * h;
    ASSERT_TRUE(balance(at.data(), down.data()));
    EXPECT_LT((jacobian.col(i) - (up - down) / (2 * h)).norm(), 1e-4 * jacobian.norm()) << i;
  }
}

// One tendon alone bends the rod towards itself: it is pulled through, the others let go.
TEST(TdcrMemory, DirectionsAreThoseThatSlide) {
  const Robot robot = Nominal();
  for (const Method method : kMethods) {
    const Loads loads = Pull(robot, {4, 1, 1});
    Loads given = loads;
    given.direction = {1, -1, -1};
    const Solution s = SolveCase(robot, loads, method);
    const Solution expected = SolveCase(robot, given, method);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    EXPECT_LT((s.disks - expected.disks).norm(), 1e-9);
    Loads other = loads;
    other.direction = {1, 1, 1};
    EXPECT_GT((SolveCase(robot, other, method).disks - s.disks).norm(), 1e-3);
    const Contacts& c = s.contacts;
    EXPECT_GT(c.share.topRows(8).col(0).minCoeff(), 0.999);
    EXPECT_LT(c.share.topRows(8).rightCols<2>().maxCoeff(), -0.999);
  }
}

TEST(TdcrMemory, HoldingStillMovesNothing) {
  const Robot robot = Nominal();
  const Loads loads = Pull(robot, {4, 1, 2});
  for (const Method method : kMethods) {
    const Solution first = SolveCase(robot, loads, method);
    Solution state = first;
    for (int row = 0; row < 1000; ++row) {
      state = SolveFrom(robot, loads, state, loads, method);
      ASSERT_TRUE(state.outcome.ok()) << state.outcome.why;
    }
    EXPECT_LT((state.disks - first.disks).colwise().norm().maxCoeff(), 1e-9);
  }
}

TEST(TdcrMemory, OnePullDoesNotDependOnTheNumberOfRows) {
  const Robot robot = Nominal();
  const std::vector<double> low{1, 0.5, 0.5}, high{5, 1, 0.5};
  for (const Method method : kMethods) {
    const Solution start = SolveCase(robot, Pull(robot, low), method);
    const Solution once = InRows(robot, low, high, 1, method, start);
    for (const int rows : {2, 10, 100}) {
      const Solution parts = InRows(robot, low, high, rows, method, start);
      EXPECT_LT((Tip(parts) - Tip(once)).norm(), 1e-6) << rows;
    }
    EXPECT_LT((Tip(SolveCase(robot, Pull(robot, high), method)) - Tip(once)).norm(), 1e-6);
  }
}

TEST(TdcrMemory, ACycleClosesAHysteresisLoop) {
  const Robot robot = Nominal();
  const std::vector<double> low{1, 0.5, 0.5}, high{5, 0.5, 0.5};
  for (const Method method : kMethods) {
    const Solution start = SolveCase(robot, Pull(robot, low), method);
    const Solution up = InRows(robot, low, high, 10, method, start);
    const Solution down = InRows(robot, high, low, 10, method, up);
    const Solution again = InRows(robot, low, high, 10, method, down);
    const Solution back = InRows(robot, high, low, 10, method, again);
    const Solution third = InRows(robot, low, high, 10, method, back);
    EXPECT_LT((Tip(third) - Tip(again)).norm(), 1e-9);
    EXPECT_LT((Tip(back) - Tip(down)).norm(), 1e-9);
    EXPECT_GT((Tip(down) - Tip(start)).norm(), 5e-4);  // friction keeps it bent
    // Far enough back everything slides the other way: as a tendon that is released.
    Loads released = Pull(robot, low);
    released.direction = {-1, 1, 1};
    EXPECT_LT((Tip(down) - Tip(SolveCase(robot, released, method))).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace continuum::tdcr
