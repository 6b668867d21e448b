// ctest labels: slow
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "models/statics/slide.h"
#include "models/tdcr/model.h"
#include "models/tdcr/polygon.h"
#include "models/tdcr/pulled_rows.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

constexpr auto kRod = Method::kCrtFriction;

TEST(TdcrRodMemory, DirectionsAreThoseThatSlide) {
  const Robot robot = Nominal();
  const Loads loads = Pull(robot, {4, 1, 1});
  Loads given = loads;
  given.direction = {1, -1, -1};
  const Solution s = SolveCase(robot, loads, kRod);
  ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
  EXPECT_LT((s.disks - SolveCase(robot, given, kRod).disks).norm(), 2e-8 * robot.length);
  EXPECT_GT(s.contacts.share.col(0).minCoeff(), 0.999);
  EXPECT_LT(s.contacts.share.rightCols<2>().maxCoeff(), -0.999);
}

TEST(TdcrRodMemory, HoldingStillMovesNothing) {
  const Robot robot = Nominal();
  const Loads loads = Pull(robot, {4, 1, 2});
  const Solution first = SolveCase(robot, loads, kRod);
  Solution state = first;
  for (int row = 0; row < 100; ++row) {
    state = SolveFrom(robot, loads, state, loads, kRod);
    ASSERT_TRUE(state.outcome.ok()) << state.outcome.why;
  }
  EXPECT_LT((state.disks - first.disks).colwise().norm().maxCoeff(), 1e-9);
}

TEST(TdcrRodMemory, OnePullDoesNotDependOnTheNumberOfRows) {
  const Robot robot = Nominal();
  const std::vector<double> low{1, 0.5, 0.5}, high{5, 1, 0.5};
  const Solution start = SolveCase(robot, Pull(robot, low), kRod);
  const Solution once = InRows(robot, low, high, 1, kRod, start);
  for (const int rows : {2, 10}) {
    EXPECT_LT((Tip(InRows(robot, low, high, rows, kRod, start)) - Tip(once)).norm(), 1e-6) << rows;
  }
  EXPECT_LT((Tip(SolveCase(robot, Pull(robot, high), kRod)) - Tip(once)).norm(), 1e-6);
}

// The precurved rod turns as it bends: contacts slide one way and then the other within a row.
TEST(TdcrRodMemory, ContactsThatTurnBackWithinARowAreFollowed) {
  Robot robot = Nominal();
  robot.natural = {3, -4, 2.5};
  struct Row {
    std::vector<double> low, high;
  };
  for (const Row& row :
       {Row{{0.72, 0.33, 0.29}, {0.52, 2.41, 4.82}}, {{1.96, 1.74, 0.58}, {7.69, 4.31, 5.42}}}) {
    const Solution start = SolveCase(robot, Pull(robot, row.low), kRod);
    const Solution once = InRows(robot, row.low, row.high, 1, kRod, start);
    const Solution parts = InRows(robot, row.low, row.high, 100, kRod, start);
    EXPECT_LT((Tip(once) - Tip(parts)).norm(), 1e-6);
  }
}

TEST(TdcrRodMemory, ACycleClosesAHysteresisLoop) {
  const Robot robot = Nominal();
  const std::vector<double> low{1, 0.5, 0.5}, high{5, 0.5, 0.5};
  const Solution start = SolveCase(robot, Pull(robot, low), kRod);
  const Solution up = InRows(robot, low, high, 2, kRod, start);
  const Solution down = InRows(robot, high, low, 2, kRod, up);
  const Solution again = InRows(robot, low, high, 2, kRod, down);
  const Solution back = InRows(robot, high, low, 2, kRod, again);
  EXPECT_LT((Tip(back) - Tip(down)).norm(), 1e-9);
  EXPECT_GT((Tip(down) - Tip(start)).norm(), 5e-4);
  Loads released = Pull(robot, low);
  released.direction = {-1, 1, 1};
  EXPECT_LT((Tip(down) - Tip(SolveCase(robot, released, kRod))).norm(), 1e-6);
}

// On the way back some contacts have turned and others hold. The balance of that state by the
// polygon, and its shares from the lengths of that state and of the one that contacts slid from.
TEST(TdcrRodMemory, APartOfTheWayBackIsThatOfAnIndependentPolygon) {
  const Robot robot = Nominal();
  const std::vector<double> low{1, 0.5, 0.5}, high{5, 0.5, 0.5}, part{4.4, 0.5, 0.5};
  const Solution start = SolveCase(robot, Pull(robot, low), kRod);
  const Solution up = InRows(robot, low, high, 4, kRod, start);
  const Solution down = InRows(robot, high, part, 1, kRod, up);
  const Contacts& c = down.contacts;
  EXPECT_LT(c.share.col(0).minCoeff(), -0.9);  // the base has turned
  EXPECT_GT(c.share.col(0).maxCoeff(), 0.9);   // the tip has not
  const Loads loads = Pull(robot, part);
  const Eigen::Index contacts = c.share.rows();
  Eigen::Vector3d beyond = Eigen::Vector3d::Zero();
  for (Eigen::Index i = contacts - 1; i >= 0; --i) {
    beyond += (down.from.length.row(i) - c.length.row(i)).transpose();
    for (int k = 0; k < 3; ++k) {
      const double share = statics::SlideFrom(down.from.share(i, k), beyond[k] / kGivesWay);
      EXPECT_NEAR(c.share(i, k), share, 1e-9);
    }
  }
  const Eigen::Matrix3Xd coarse = Polygon(robot, loads, 24, c.share).Disks();
  const Eigen::Matrix3Xd fine = Polygon(robot, loads, 48, c.share).Disks();
  const double last = (coarse - down.disks).norm(), now = (fine - down.disks).norm();
  EXPECT_LT(now, 0.3 * last);  // the polygon is of second order
  EXPECT_LT(now, 1e-6 * robot.length);
}

// A matrix of all contacts would take 100 GB.
TEST(TdcrRodMemory, MoreContactsThanAMatrixHoldsAreRefused) {
  Robot robot = Nominal();
  robot.disks = 1000;
  robot.tendons = 64;
  Loads loads = NoLoads(robot);
  loads.tension[0] = 1;
  EXPECT_TRUE(SolveCase(robot, loads, kRod).outcome.ok());
  loads.direction.assign(64, kAsItSlides);
  const Solution s = SolveCase(robot, loads, kRod);
  EXPECT_FALSE(s.outcome.ok());
  EXPECT_EQ(s.outcome.why.find("128000 contacts that remember, at most 5000"), 0U);
}

TEST(TdcrRodMemory, ARowWithGivenDirectionsMayBeAReference) {
  const Robot robot = Nominal();
  Loads given = Pull(robot, {4, 1, 1});
  const Solution automatic = SolveCase(robot, given, kRod);
  given.direction = {1, -1, -1};
  const Solution first = SolveCase(robot, given, kRod);
  const Loads next = Pull(robot, {4.5, 1, 1});
  const Solution a = SolveFrom(robot, given, first, next, kRod);
  const Solution b = SolveFrom(robot, Pull(robot, {4, 1, 1}), automatic, next, kRod);
  ASSERT_TRUE(a.outcome.ok()) << a.outcome.why;
  ASSERT_TRUE(b.outcome.ok()) << b.outcome.why;
  EXPECT_LT((Tip(a) - Tip(b)).norm(), 1e-8);
}

}  // namespace
}  // namespace continuum::tdcr
