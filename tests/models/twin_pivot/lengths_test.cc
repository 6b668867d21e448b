#include <gtest/gtest.h>

#include <cmath>

#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/details.h"

namespace continuum::twin_pivot {
namespace {

// What is wound of every cable: its parts without the tensions along it, l/(1 + T/EA).
VectorXd Wound(const Robot& robot, const Solution& s) {
  const auto wound = s.length.array() / (1 + s.tension.array() / robot.cable_EA);
  return wound.colwise().sum().transpose();
}

// The lengths of shapes that tensions have made give these tensions again. Without stretch opposite
// taut cables share their tension in no way of their own.
TEST(TwinPivotLengths, TakeBackWhatTensionsHaveMade) {
  for (const char* name : {"a", "b"}) {
    Robot robot = Prototype(name);
    robot.cable_EA = 3e3;
    for (const Condition condition : {Condition::kI, Condition::kV}) {
      std::vector<double> tension;
      for (int j = 0; j < robot.Cables(); ++j) tension.push_back(3 + 0.7 * ((j * 5) % 4));
      const Load pulled = Pull(tension, condition);
      const Solution by_tension = Solve(robot, pulled);
      ASSERT_TRUE(by_tension.outcome.ok());
      Load wound = pulled;
      wound.length = Wound(robot, by_tension);
      const Solution s = Solve(robot, wound);
      ASSERT_TRUE(s.outcome.ok()) << name << ": " << s.outcome.why;
      EXPECT_LT((s.tip - by_tension.tip).norm(), 1e-6) << name;
      for (int j = 0; j < robot.Cables(); ++j) {
        EXPECT_NEAR(s.pull[j], tension[static_cast<std::size_t>(j)], 1e-2) << name << j;
      }
    }
  }
}

// Without weights and friction the two upper cables wound alike bend every odd joint and every even
// one alike; those opposite are slack where they are given enough.
TEST(TwinPivotLengths, SlackCablesHaveNoTension) {
  const Robot robot = Weightless(Prototype("a"));
  Load load = Pull({}, Condition::kI);
  load.tension.assign(4, 0);
  const double straight = 6 * robot.L[0];
  load.length = VectorXd::Constant(4, straight + 2e-3);
  load.length.head<2>().setConstant(straight - 1e-3);
  const Solution s = Solve(robot, load);
  ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
  EXPECT_GT(s.pull[0], 0.1);
  EXPECT_NEAR(s.pull[0], s.pull[1], 1e-6);
  EXPECT_EQ(s.pull[2], 0);
  EXPECT_EQ(s.pull[3], 0);
  const statics::Details details = Describe(robot, load, s);
  EXPECT_NEAR(details.length[0], load.length[0], 1e-9);
  EXPECT_LT(details.length[2], load.length[2]);
  EXPECT_GT(s.tip.y(), 1e-3);
}

// All cables wound by a share e of their length: stretch alone, T = EA e/(1 - e), whether the
// cables are of steel or of rubber.
TEST(TwinPivotLengths, EqualWindingIsStretchAlone) {
  for (const double e : {1e-4, 0.02, 0.3}) {
    Robot robot = Weightless(Prototype("a"));
    robot.cable_EA = 2 * (1 - e) / e;
    Load load = Pull({}, Condition::kI);
    load.tension.assign(4, 0);
    load.length = VectorXd::Constant(4, 6 * robot.L[0] * (1 - e));
    const Solution s = Solve(robot, load);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(s.pull[j], 2, 1e-8) << e;
    EXPECT_LT(std::hypot(s.tip.y(), s.tip.z()), 1e-9);
  }
}

// Friction takes the tension along the cable, and the contacts go on from row to row.
TEST(TwinPivotLengths, WindingInRowsIsWindingInOne) {
  const Robot robot = Prototype("b");
  const auto at = [&](double share) {
    Load load = Pull({}, Condition::kV);
    load.tension.assign(4, 0);
    load.length = VectorXd::Constant(4, 12 * robot.L[0] + 4e-3);
    load.length.head<2>().array() -= 4e-3 + share * 3e-3;
    return load;
  };
  const Solution once = Solve(robot, at(1));
  ASSERT_TRUE(once.outcome.ok()) << once.outcome.why;
  Solution state = Solve(robot, at(0.25));
  for (int row = 2; row <= 4; ++row) {
    state = SolveFrom(robot, at(0.25 * (row - 1)), state, at(0.25 * row));
    ASSERT_TRUE(state.outcome.ok()) << row << ": " << state.outcome.why;
  }
  const Solution held = SolveFrom(robot, at(1), state, at(1));
  EXPECT_LT((held.tip - state.tip).norm(), 1e-9);
  EXPECT_LT((state.tip - once.tip).norm(), 1e-4);  // weights came at once, or before the winding
}

}  // namespace
}  // namespace continuum::twin_pivot
