#include "models/twin_pivot/follow.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {
namespace {

// Without loads the straight robot lies on a straight path: at least tension, by symmetry equal.
TEST(TwinPivotFollow, AStraightPathNeedsNoTension) {
  const Robot robot = Weightless(Prototype("a"));
  const PathLine path(CsvTable::Parse("x,y,z,low\n0.01,0,0,1\n0.05,0,0,1\n0.2,0,0,1\n", "path"));
  const auto rows = Follow(robot, Pull({2, 2, 2, 2}), Method::kVirtualWork, path);
  ASSERT_EQ(rows.size(), 3U);
  const double ends[] = {0.01, 0.05, 0.2};
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(rows[i].solution.outcome.ok());
    EXPECT_NEAR(rows[i].base, ends[i] - robot.Length(), 1e-12);
    EXPECT_LT(rows[i].off.maxCoeff(), 1e-8);
    for (const double tension : rows[i].load.tension) EXPECT_NEAR(tension, 1, 1e-3);
  }
}

// The path is a shape of the robot itself, which a whole insertion has to find again.
TEST(TwinPivotFollow, LiesOnAShapeThatItHasMadeBefore) {
  Robot robot = Weightless(Prototype("a"));
  robot.friction = {};
  const Solution made = Solve(robot, Pull({6, 5, 1, 2}));
  ASSERT_TRUE(made.outcome.ok());
  std::string text = "x,y,z,low\n";
  for (const Vector3d& p : CentreLine(robot, made.beta, 20)) {
    if (p.x() > 0 && p.x() < 0.5 * robot.h[0] + 1e-9) continue;  // O_0 and this are on the axis
    text += fmt::format("{:.17g},{:.17g},{:.17g},1\n", p.x(), p.y(), p.z());
  }
  const PathLine path(CsvTable::Parse(text, "path"));
  const auto rows = Follow(robot, Pull({2, 2, 2, 2}), Method::kVirtualWork, path);
  const Following& last = rows.back();
  ASSERT_TRUE(last.solution.outcome.ok());
  EXPECT_NEAR(last.base, 0, 1e-6);  // by the chords of the path
  // The price of tension, 1e-7 |F r/k|^2, holds it off by some 1e-5 of the length.
  EXPECT_LT(last.off.maxCoeff(), 1e-5);
  EXPECT_LT((last.solution.tip - made.tip).norm(), 2e-5);
  for (const double tension : last.load.tension) EXPECT_GE(tension, 1 - 1e-12);
}

// With friction the contacts of the insertion are not those of the one pull that made the shape.
TEST(TwinPivotFollow, ComesNearAShapeThatWasPulledWithFriction) {
  const Robot robot = Weightless(Prototype("b"));
  const Solution made = Solve(robot, Pull({4, 3, 0.5, 1}));
  ASSERT_TRUE(made.outcome.ok());
  std::string text = "x,y,z,low\n";
  for (const Vector3d& p : CentreLine(robot, made.beta, 3)) {
    if (p.x() > 0 && p.x() < 0.5 * robot.h[0] + 1e-9) continue;
    text += fmt::format("{:.17g},{:.17g},{:.17g},0.5\n", p.x(), p.y(), p.z());
  }
  const PathLine path(CsvTable::Parse(text, "path"));
  for (const double first : {1.0, 4.0}) {
    const auto rows = Follow(robot, Pull({first, first, first, first}), Method::kVirtualWork, path);
    ASSERT_TRUE(rows.back().solution.outcome.ok());
    EXPECT_LT(rows.back().off.maxCoeff(), 5e-3 * robot.Length()) << first;
  }
}

TEST(TwinPivotFollow, DistancesAreThoseToTheNearestLine) {
  const PathLine path(CsvTable::Parse("x,y,z\n0,0,0\n0.1,0,0\n0.1,0.1,0\n", "path"));
  EXPECT_NEAR(path.Distance({-0.2, 0.003, 0.004}), 0.005, 1e-15);
  EXPECT_NEAR(path.Distance({0.09, 0.05, 0}), 0.01, 1e-15);
  EXPECT_NEAR(path.Distance({0.1, 0.2, 0}), 0.1, 1e-15);
  EXPECT_LT((path.At(0.15) - Vector3d(0.1, 0.05, 0)).norm(), 1e-15);
  EXPECT_LT((path.At(-0.15) - Vector3d(-0.15, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(path.Base(2, 0.15), 0.05, 1e-15);
}

}  // namespace
}  // namespace continuum::twin_pivot
