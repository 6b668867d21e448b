#include "models/tdcr/reach.h"

#include <gmock/gmock.h>

#include "models/tdcr/pulled_rows.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

double Squares(const std::vector<double>& tension) {
  return VectorXd::Map(tension.data(), static_cast<Eigen::Index>(tension.size())).squaredNorm();
}

// Of the tip.
statics::Target At(const Vector3d& tip) { return {"", {24, 25, 26}, tip}; }

// The tip of a pull with all tendons taut is reached, and with less.
TEST(TdcrReach, FindsTheLeastTensionsOfATip) {
  const Robot robot = Nominal();
  for (const Method method : {Method::kEas, Method::kPcca, Method::kCrt, Method::kCrtFriction}) {
    SCOPED_TRACE(static_cast<int>(method));
    Loads loads = Pull(robot, {4, 1.5, 0.7});
    loads.direction.assign(3, 1);
    const Vector3d tip = Tip(SolveCase(robot, loads, method));
    Loads start = loads;
    start.tension.assign(3, 0);
    const auto reached = Reach(robot, start, method, At(tip), nullptr);
    ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
    EXPECT_LT(reached.miss, 1e-6 * robot.length);
    EXPECT_GE(reached.drives.minCoeff(), 0);
    EXPECT_LE(reached.drives.squaredNorm(), Squares(loads.tension) * (1 + 1e-6));
  }
}

// On the way back other tensions lead to the same place: those that the history has made.
TEST(TdcrReach, TakesFrictionByHistory) {
  const Robot robot = Nominal();
  const Loads low = Pull(robot, {1, 0.5, 0.5}), high = Pull(robot, {5, 0.5, 0.5});
  const Solution start = SolveCase(robot, low, Method::kEas);
  const Solution up = SolveFrom(robot, low, start, high, Method::kEas);
  const Loads middle = Pull(robot, {2.5, 0.5, 0.5});
  const Vector3d tip = Tip(SolveFrom(robot, high, up, middle, Method::kEas));
  const statics::Target target{"", {24, 25}, tip.head<2>()};
  const Before released{high, up}, pulled{low, start};
  const auto back = Reach(robot, middle, Method::kEas, target, &released);
  const auto on = Reach(robot, middle, Method::kEas, target, &pulled);
  ASSERT_TRUE(back.outcome.ok()) << back.outcome.why;
  ASSERT_TRUE(on.outcome.ok()) << on.outcome.why;
  EXPECT_GT((back.drives - on.drives).norm(), 0.1);
  Loads found = middle;
  found.tension.assign(back.drives.begin(), back.drives.end());
  const Solution there = SolveFrom(robot, high, up, found, Method::kEas);
  EXPECT_LT((Tip(there) - tip).head<2>().norm(), 2e-7);
}

// More points than tensions: a shape of the model itself is found again.
TEST(TdcrReach, FindsAShape) {
  const Robot robot = Nominal();
  Loads loads = Pull(robot, {3, 0, 1});
  loads.direction.assign(3, 1);
  const Solution shape = SolveCase(robot, loads, Method::kCrt);
  statics::Target target{"", {6, 7, 8, 15, 16, 17, 24, 25, 26}, VectorXd(9)};
  target.values << shape.disks.col(2), shape.disks.col(5), shape.disks.col(8);
  Loads start = loads;
  start.tension.assign(3, 0);
  const auto reached = Reach(robot, start, Method::kCrt, target, nullptr);
  ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
  EXPECT_LT(reached.miss, 1e-8);
}

TEST(TdcrReach, SaysHowFarAPlaceIsOutOfReach) {
  const Robot robot = Nominal();
  Loads loads = NoLoads(robot);
  statics::Target target = At({0.06, 0, 0.11});
  target.high = 1;
  const auto reached = Reach(robot, loads, Method::kEas, target, nullptr);
  EXPECT_FALSE(reached.outcome.ok());
  EXPECT_THAT(reached.outcome.why, testing::HasSubstr("out of reach"));
  EXPECT_GT(reached.miss, 1e-3);
  EXPECT_LE(reached.drives.maxCoeff(), 1 + 1e-12);
}

// Farther from the base than the rod is long: no search is needed to say so.
TEST(TdcrReach, APlaceFartherThanTheRodIsLongIsOutOfReachAtOnce) {
  const Robot robot = Nominal();
  const Loads loads = Pull(robot, {1, 1, 1});
  const statics::Target far{"", {24, 26}, Eigen::Vector2d(0.1, 0.1)};
  const auto reached = Reach(robot, loads, Method::kCrt, far, nullptr);
  EXPECT_TRUE(reached.out_of_reach());
  EXPECT_EQ(reached.outcome.iterations, 0);
  EXPECT_THAT(reached.outcome.why, testing::HasSubstr("disk 9 is at most 0.134 m away"));
}

// The lengths of the least tensions, from unwound tendons; they lead there again.
TEST(TdcrReach, FindsLengthsThatLeadToATip) {
  for (const Method method : {Method::kEas, Method::kCrt}) {
    for (const double EA : {5e3, 0.0}) {
      SCOPED_TRACE(EA);
      Robot robot = Nominal();
      robot.tendon_EA = EA;
      Loads loads = Pull(robot, {4, 1.5, EA > 0 ? 0.7 : 0});
      const Vector3d tip = Tip(SolveCase(robot, loads, method));
      loads.length = VectorXd::Constant(3, 1.01 * robot.length);
      const statics::Target target{"", {24, 25}, tip.head<2>(), EA > 0 ? 0.5 : 0};
      const auto reached = ReachByLengths(robot, loads, method, target, nullptr);
      ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
      loads.length = reached.drives;
      const Solution wound = SolveCase(robot, loads, method);
      ASSERT_TRUE(wound.outcome.ok()) << wound.outcome.why;
      EXPECT_LT((Tip(wound) - tip).head<2>().norm(), 1e-6 * robot.length);
      EXPECT_GE(wound.pull.minCoeff(), EA > 0 ? 0.4 : 0);
    }
  }
}

}  // namespace
}  // namespace continuum::tdcr
