#include "models/statics/reach.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include "error.h"
#include "models/statics/box_least_squares.h"

namespace continuum::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Against all choices of which unknowns are at which limit.
TEST(WithinLimits, IsTheBestOfAllSidesOfTheBox) {
  std::srand(7);
  for (int trial = 0; trial < 200; ++trial) {
    const MatrixXd A = MatrixXd::Random(3, 4);
    const MatrixXd H = A.transpose() * A + 0.01 * MatrixXd::Identity(4, 4);
    const VectorXd g = VectorXd::Random(4);
    const VectorXd low = VectorXd::Constant(4, -0.3), high = VectorXd::Constant(4, 0.5);
    const auto value = [&](const VectorXd& w) { return 0.5 * w.dot(H * w) - g.dot(w); };
    double best = 1e9;
    for (int sides = 0; sides < 81; ++sides) {
      VectorXd w = VectorXd::Zero(4);
      std::vector<int> free;
      for (int i = 0, rest = sides; i < 4; ++i, rest /= 3) {
        if (rest % 3 == 0) free.push_back(i);
        w[i] = rest % 3 == 1 ? low[i] : rest % 3 == 2 ? high[i] : 0;
      }
      const VectorXd right = g - H * w;
      if (!free.empty()) {
        const MatrixXd its = H(free, free);
        w(free) = its.inverse() * VectorXd(right(free));
      }
      if ((w - low).minCoeff() >= -1e-12 && (high - w).minCoeff() >= -1e-12) {
        best = std::min(best, value(w));
      }
    }
    const VectorXd is = WithinLimits(H, g, low, high);
    EXPECT_GE((is - low).minCoeff(), 0);
    EXPECT_GE((high - is).minCoeff(), 0);
    EXPECT_NEAR(value(is), best, 1e-12);
  }
}

// Three drives at 120 degrees move a point in a plane: the least ones have one of them slack.
TEST(Reach, TakesTheLeastDrives) {
  MatrixXd by(3, 3);
  by << 1, -0.5, -0.5, 0, std::sqrt(3) / 2, -std::sqrt(3) / 2, 0, 0, 0;
  const auto stand = [&](const VectorXd& w) -> std::optional<Stand> {
    const VectorXd p = by * w;
    return Stand{p.array().sin(), p.array().cos().matrix().asDiagonal() * by};
  };
  Target target{"", {0, 1, 2}, Eigen::Vector3d(0.5, 0.3, 0)};
  const Reached reached = Reach(stand, VectorXd::Zero(3), target, 1, 1);
  ASSERT_TRUE(reached.outcome.ok()) << reached.outcome.why;
  EXPECT_LT(reached.miss, 1e-8);
  EXPECT_NEAR(reached.drives.minCoeff(), 0, 1e-12);
  target.high = 0.4;
  const Reached limited = Reach(stand, VectorXd::Zero(3), target, 1, 1);
  EXPECT_FALSE(limited.outcome.ok());
  EXPECT_THAT(limited.outcome.why, testing::HasSubstr("out of reach"));
  EXPECT_LE(limited.drives.maxCoeff(), 0.4);
}

// From the start downhill ends at a local minimum of the distance; without drives it does not.
TEST(Reach, BeginsAgainWithoutDrives) {
  const auto stand = [](const VectorXd& w) -> std::optional<Stand> {
    if (w[0] > 8) return std::nullopt;
    return Stand{VectorXd::Constant(1, std::sin(w[0])), MatrixXd::Constant(1, 1, std::cos(w[0]))};
  };
  Target target{"", {0}, VectorXd::Constant(1, 0.5)};
  for (const double start : {1.0, 4.8, 9.0}) {
    const Reached reached = Reach(stand, VectorXd::Constant(1, start), target, 1, 1);
    ASSERT_TRUE(reached.outcome.ok()) << start << ": " << reached.outcome.why;
    EXPECT_NEAR(std::sin(reached.drives[0]), 0.5, 1e-8);
  }
  target.values[0] = 2;
  const Reached missed = Reach(stand, VectorXd::Zero(1), target, 1, 1);
  EXPECT_TRUE(missed.out_of_reach()) << missed.outcome.why;
  EXPECT_NEAR(missed.miss, 1, 1e-3);
}

TEST(ReadTargets, TakesTheTipAndAnyDisks) {
  const auto targets = ReadTargets(
      CsvTable::Parse("case,x,y,z,x_1,y_1,z_1,high\na,1,2,3,,,,5\nb,,,,4,,6,7\n", "t"), 9);
  ASSERT_EQ(targets.size(), 2U);
  EXPECT_EQ(targets[0].coordinate, (std::vector<int>{24, 25, 26}));
  EXPECT_EQ(targets[1].coordinate, (std::vector<int>{0, 2}));
  EXPECT_EQ(targets[1].values, Eigen::Vector2d(4, 6));
  EXPECT_EQ(targets[1].high, 7);
  for (const char* wrong :
       {"case,x,y\na,,\n", "case,x,y,z,q\na,1,2,3,4\n", "case,x,y,z,low,high\na,1,2,3,4,3\n",
        "case,x,y\na,nan,1\n", "case,x,x_9\na,1,2\n", "case,x,low\na,1,-2\n"}) {
    EXPECT_THROW(ReadTargets(CsvTable::Parse(wrong, "t"), 9), Error) << wrong;
  }
  EXPECT_EQ(ReadTargets(CsvTable::Parse("case,x,low\na,1,-2\n", "t"), 9, -3)[0].low, -2);
  EXPECT_THROW(TargetsOf(targets, {"a"}, "t"), Error);
  EXPECT_THROW(TargetsOf({targets[0], targets[0]}, {"a"}, "t"), Error);
  EXPECT_THROW(TargetsOf(targets, {"a", "b", "c"}, "t"), Error);
}

}  // namespace
}  // namespace continuum::statics
