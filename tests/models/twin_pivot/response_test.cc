#include "models/twin_pivot/response.h"

#include <gtest/gtest.h>

#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::MatrixXd;

Load Moved(Load load, int i, double step) {
  if (i < 3) {
    load.force[i] += step;
  } else if (i < 6) {
    load.moment[i - 3] += step / 10;
  } else if (load.length.size() > 0) {
    load.length[i - 6] += step / 100;
  } else {
    load.tension[static_cast<std::size_t>(i - 6)] += step;
  }
  return load;
}
double Size(const Load& load, int i, double step) {
  return i < 3 ? step : i < 6 ? step / 10 : load.length.size() > 0 ? step / 100 : step;
}

// Central differences of solves: of the tip, its turn, and lengths or tensions.
template <class Solve>
MatrixXd Differences(const Robot& robot, const Load& load, double step, const Solve& solve) {
  MatrixXd slopes(6 + robot.Cables(), 6 + robot.Cables());
  for (int i = 0; i < slopes.cols(); ++i) {
    const Solution above = solve(Moved(load, i, step)), below = solve(Moved(load, i, -step));
    EXPECT_TRUE(above.outcome.ok() && below.outcome.ok()) << i;
    const auto frame = [&](const Solution& s) {
      return Eigen::Quaterniond(DiscFrames(robot, s.beta).back().rotation());
    };
    const auto cables = [&](const Solution& s) {
      return load.length.size() > 0 ? s.pull : VectorXd(s.length.colwise().sum());
    };
    const Eigen::Quaterniond turn = frame(above) * frame(below).conjugate();
    slopes.col(i) << above.tip - below.tip, 2 * turn.vec() * (turn.w() < 0 ? -1 : 1),
        cables(above) - cables(below);
    slopes.col(i) /= 2 * Size(load, i, step);
  }
  return slopes;
}

// Blocks of rows have units of their own.
void ExpectEqual(const MatrixXd& is, const MatrixXd& expected, double tolerance) {
  const int cables = static_cast<int>(expected.rows()) - 6;
  for (const auto& [first, count] : {std::pair(0, 3), std::pair(3, 3), std::pair(6, cables)}) {
    const MatrixXd a = is.middleRows(first, count), b = expected.middleRows(first, count);
    for (int i = 0; i < is.cols(); ++i) {
      EXPECT_LT((a.col(i) - b.col(i)).norm(), tolerance * (b.col(i).norm() + 1e-3 * b.norm()))
          << "rows from " << first << ", input " << i;
    }
  }
}

class ResponseOfPrototype : public EveryPrototype {};
INSTANTIATE_TEST_SUITE_P(TwinPivot, ResponseOfPrototype, testing::Values("a", "b", "c"));

TEST_P(ResponseOfPrototype, IsThatOfDifferencesOfSolves) {
  load_.force = {0.01, 0.02, -0.01};
  for (const Condition condition : {Condition::kI, Condition::kV}) {
    load_.condition = condition;
    const Solution s = Solve(robot_, load_);
    ASSERT_TRUE(s.outcome.ok());
    const auto response = Respond(robot_, load_, Method::kVirtualWork, s);
    ASSERT_TRUE(response);
    const auto near = [&](const Load& at) {
      return SolveNear(robot_, at, Method::kVirtualWork, s.beta, robot_.eps);
    };
    // Steps of 1e-5 N move cables by less than a contact's 1 um.
    ExpectEqual(response->slope, Differences(robot_, load_, 1e-5, near), 1e-3);
  }
}

// Virtual work without friction has a potential: compliances are symmetric, dp/dF_k = -dl_k/dF.
TEST(TwinPivotResponse, WithoutFrictionIsReciprocal) {
  const Robot robot = Prototype("b");
  const Load load = Pull({5, 2, 1, 3}, Condition::kI);
  const auto response = Respond(robot, load, Method::kVirtualWork, Solve(robot, load));
  ASSERT_TRUE(response);
  const MatrixXd& slope = response->slope;
  const MatrixXd by_force = slope.topLeftCorner(3, 3), turns = slope.block(3, 0, 3, 3);
  EXPECT_LT((by_force - by_force.transpose()).norm(), 1e-6 * by_force.norm());
  EXPECT_LT((turns - slope.block(0, 3, 3, 3).transpose()).norm(), 1e-6 * turns.norm());
  const MatrixXd by_pull = slope.topRightCorner(3, 4), lengths = slope.block(6, 0, 4, 3);
  EXPECT_LT((by_pull + lengths.transpose()).norm(), 1e-6 * by_pull.norm());
}

TEST(TwinPivotResponse, OfWinchesIsThatOfDifferencesOfSolves) {
  Robot robot = Prototype("a");
  robot.cable_EA = 3e3;
  Load load = Pull({4, 3.7, 3, 5}, Condition::kI);
  const Solution by_tension = Solve(robot, load);
  load.length =
      (by_tension.length - by_tension.length.cwiseProduct(by_tension.tension) / robot.cable_EA)
          .colwise()
          .sum();
  const Solution s = Solve(robot, load);
  ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
  load.tension.assign(s.pull.begin(), s.pull.end());
  const auto response = Respond(robot, load, Method::kVirtualWork, s);
  ASSERT_TRUE(response);
  const auto solve = [&](const Load& at) { return Solve(robot, at); };
  ExpectEqual(response->slope, Differences(robot, load, 1e-4, solve), 1e-4);
}

}  // namespace
}  // namespace continuum::twin_pivot
