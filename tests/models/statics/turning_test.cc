#include "models/statics/turning.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/statics/rising_load.h"
#include "models/statics/slide.h"

namespace continuum::statics {
namespace {

using Eigen::VectorXd;

TEST(Turning, AParabolaTurnsWhereItsRateIsZero) {
  // x = 2 t - 3 t^2 turns at 1/3, where it is 1/3; it ends at -1.
  const Turn turn = TurnBefore(-1, -4);
  EXPECT_NEAR(turn.at, 1. / 3, 1e-15);
  EXPECT_NEAR(turn.unseen, 1. / 3, 1e-15);
  // x = 4 t - 3 t^2 turns at 2/3, where it is 4/3; it ends at 1.
  EXPECT_NEAR(TurnBefore(1, -2).at, 2. / 3, 1e-15);
  EXPECT_NEAR(TurnBefore(1, -2).unseen, 1. / 3, 1e-15);
  EXPECT_EQ(TurnBefore(1, 1.5).at, 1);  // x = t/2 + t^2/2
}

TEST(Turning, TheFirstContactThatTurnsCutsTheStep) {
  const VectorXd way = VectorXd::Map(std::vector{1., -1., 1.}.data(), 3);
  const VectorXd end = VectorXd::Map(std::vector{-2., -4., 1.}.data(), 3);
  EXPECT_NEAR(FirstTurn({}, way, end, 0.1), 1. / 3, 1e-15);
  EXPECT_EQ(FirstTurn({}, way, end, 0.4), 1);
  // The third went back first: x = -2 t + 3 t^2 by its rate at the beginning.
  const VectorXd begin = VectorXd::Map(std::vector{4., 2., -2.}.data(), 3);
  EXPECT_NEAR(FirstTurn(begin, way, VectorXd::Ones(3), 0.1), 1. / 3, 1e-15);
}

/// A block on a spring under a force p that rises and falls, with a contact that gives way within
/// 1:
///
///   x + 20 s(x) = p,  p = 400 load (0.8 - load)
class Block {
 public:
  using Vector = VectorXd;

  static double Pull(double load) { return 400 * load * (0.8 - load); }  // to 64, to -80
  double Force(double x) const { return x + kFriction * SlideFrom(share_, x - from_); }
  numerics::Outcome Correct(double load, Vector& x) const {
    numerics::Outcome outcome;
    double low = -1e3, high = 1e3;
    while (high - low > 1e-12) {
      const double middle = (low + high) / 2;
      (Force(middle) < Pull(load) ? low : high) = middle;
    }
    x[0] = low;
    outcome.status = numerics::Status::kOk;
    return outcome;
  }
  int Unstable(double /*load*/, const Vector& /*x*/) const { return 0; }
  statics::Fall Fall(double /*from*/, double /*load*/, Vector& /*x*/) const { return {}; }

  Vector Slid(const Vector& x) const { return x; }
  bool SomeRest(const Vector& x) const { return std::abs(SlideFrom(share_, x[0] - from_)) < 0.999; }
  Vector Rate(double load, const Vector& x, bool /*exact*/) const {
    constexpr double kStep = 1e-6;
    const double stiffness = (Force(x[0] + kStep) - Force(x[0] - kStep)) / (2 * kStep);
    return Vector::Constant(1, (Pull(load + kStep) - Pull(load - kStep)) / (2 * kStep) / stiffness);
  }
  void GoOnFrom(const Vector& x) {
    share_ = SlideFrom(share_, x[0] - from_);
    from_ = x[0];
    ++parts;
  }

  static constexpr double kFriction = 20;
  int parts = 1;

 private:
  double share_ = 0, from_ = 0;
};

RisingOptions AtOnce() {
  RisingOptions options;
  options.first_step = options.largest_step = 1;
  options.trust = 1e9;
  return options;
}

TEST(Turning, ABlockThatTurnsBackSlidesAgainstItsFriction) {
  Block block;
  VectorXd x = VectorXd::Zero(1);
  Branch branch = Branch::kRising;
  ASSERT_TRUE(FollowRisingLoad(block, x, branch, AtOnce()).ok());
  EXPECT_NEAR(x[0], Block::Pull(1) + Block::kFriction, 1e-6);
  EXPECT_LT(block.parts, 12);
}

// The force ends at 55: the block rests where it has turned, but for what the contact gives way.
TEST(Turning, ABlockThatTurnsBackRestsWhereItTurned) {
  static constexpr double kEnd = 0.55;
  struct Part : Block {
    numerics::Outcome Correct(double load, Vector& x) const {
      return Block::Correct(kEnd * load, x);
    }
    Vector Rate(double load, const Vector& x, bool exact) const {
      return kEnd * Block::Rate(kEnd * load, x, exact);
    }
  } block;
  VectorXd x = VectorXd::Zero(1);
  Branch branch = Branch::kRising;
  ASSERT_TRUE(FollowRisingLoad(block, x, branch, AtOnce()).ok());
  EXPECT_NEAR(x[0], 64 - Block::kFriction, 0.6);
}

}  // namespace
}  // namespace continuum::statics
