// ctest labels: slow
#include "models/tdcr/response.h"

#include <gtest/gtest.h>

#include "models/tdcr/details.h"
#include "models/tdcr/pulled_rows.h"

namespace continuum::tdcr {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Loads Bent(const Robot& robot) {
  Loads loads = NoLoads(robot);
  loads.tension = {3, 1, 0.5};
  loads.tip_force = {0.02, 0.03, -0.05};
  loads.gravity = {3, 0, 9};
  return loads;
}

// Input i of a case, moved by a step.
Loads Moved(Loads loads, int i, double step) {
  if (i < 3) {
    loads.tip_force[i] += step;
  } else if (loads.length.size() > 0) {
    loads.length[i - 3] += step;
  } else {
    loads.tension[static_cast<std::size_t>(i - 3)] += step;
  }
  return loads;
}

// Central differences of solves: of the tip, its turn, and what `shown` takes of a solution.
template <class Solve, class Shown>
MatrixXd Differences(const Robot& robot, const Loads& loads, Method method, double step,
                     const Solve& solve, const Shown& shown) {
  MatrixXd slopes(6 + robot.tendons, 3 + robot.tendons);
  for (int i = 0; i < slopes.cols(); ++i) {
    const Loads up = Moved(loads, i, step), down = Moved(loads, i, -step);
    const Solution above = solve(up), below = solve(down);
    EXPECT_TRUE(above.outcome.ok() && below.outcome.ok()) << i;
    const Eigen::Quaterniond turn = LineOf(robot, up, method, above).frames.back() *
                                    LineOf(robot, down, method, below).frames.back().conjugate();
    slopes.col(i) << Tip(above) - Tip(below), 2 * turn.vec() * (turn.w() < 0 ? -1 : 1),
        shown(up, above) - shown(down, below);
    slopes.col(i) /= 2 * step;
  }
  return slopes;
}

// Blocks of rows have units of their own.
void ExpectEqual(const MatrixXd& is, const MatrixXd& expected, double tolerance) {
  const int lengths = static_cast<int>(expected.rows()) - 6;
  for (const auto& [first, count] : {std::pair(0, 3), std::pair(3, 3), std::pair(6, lengths)}) {
    const MatrixXd a = is.middleRows(first, count), b = expected.middleRows(first, count);
    for (int i = 0; i < is.cols(); ++i) {
      EXPECT_LT((a.col(i) - b.col(i)).norm(), tolerance * (b.col(i).norm() + 1e-3 * b.norm()))
          << "rows from " << first << ", input " << i;
    }
  }
}

TEST(TdcrResponse, IsThatOfDifferencesOfSolves) {
  const Robot robot = Nominal();
  const Loads loads = Bent(robot);
  for (const Method method : {Method::kEas, Method::kPcca, Method::kCrt, Method::kCrtFriction}) {
    SCOPED_TRACE(static_cast<int>(method));
    const Solution s = SolveCase(robot, loads, method);
    const auto response = Respond(robot, loads, method, s);
    ASSERT_TRUE(response);
    const MatrixXd expected = Differences(
        robot, loads, method, 1e-4,
        [&](const Loads& at) { return SolveNear(robot, at, method, s.x); },
        [&](const Loads& at, const Solution& a) { return Describe(robot, at, method, a).length; });
    ExpectEqual(response->slope, expected, 1e-6);  // of steps of 1e-4 N of up to 3 N
  }
}

// A straight rod under a small force at its tip: L^3/(3 EI) and L^2/(2 EI).
TEST(TdcrResponse, OfAStraightRodIsTheCantilevers) {
  const Robot robot = Nominal();
  Loads loads = NoLoads(robot);
  loads.gravity.setZero();
  const auto response = Respond(robot, loads, Method::kCrt, SolveCase(robot, loads, Method::kCrt));
  ASSERT_TRUE(response);
  const double L = robot.length, EI = robot.EI();
  Eigen::Matrix<double, 6, 3> exact = Eigen::Matrix<double, 6, 3>::Zero();
  exact(0, 0) = exact(1, 1) = L * L * L / (3 * EI);
  exact(3, 1) = -L * L / (2 * EI);
  exact(4, 0) = L * L / (2 * EI);
  const Eigen::Matrix<double, 6, 3> is = response->slope.topLeftCorner<6, 3>();
  EXPECT_LT((is - exact).norm(), 1e-7 * exact.norm());  // the integrator's
  // T r/EI of curvature: L^2/2 T r/EI towards the tendon.
  EXPECT_NEAR(response->slope(0, 3), L * L / 2 * robot.tendon_radius / EI, 1e-7);
  const Eigen::Matrix3d axes = statics::Ellipsoid(*response, false);
  EXPECT_NEAR(axes.col(0).norm(), exact(0, 0), 1e-7);
  EXPECT_NEAR(axes.col(2).norm(), 0, 1e-8);
}

// Without friction there is a potential (details.h (1)), so that the compliance is symmetric, and
// dp/dT_k = -dl_k/dF.
TEST(TdcrResponse, WithoutFrictionIsReciprocal) {
  const Robot robot = Nominal();
  const Loads loads = Bent(robot);
  const auto response = Respond(robot, loads, Method::kCrt, SolveCase(robot, loads, Method::kCrt));
  ASSERT_TRUE(response);
  const MatrixXd& slope = response->slope;
  const MatrixXd by_force = slope.topLeftCorner(3, 3), by_pull = slope.topRightCorner(3, 3);
  const MatrixXd lengths = slope.block(6, 0, 3, 3), strokes = slope.block(6, 3, 3, 3);
  EXPECT_LT((by_force - by_force.transpose()).norm(), 1e-7 * by_force.norm());
  EXPECT_LT((by_pull + lengths.transpose()).norm(), 1e-7 * by_pull.norm());
  EXPECT_LT((strokes - strokes.transpose()).norm(), 1e-7 * strokes.norm());
}

// Between a pull and a release some contacts rest, and others slide.
TEST(TdcrResponse, FollowsContactsThatRemember) {
  const Robot robot = Nominal();
  for (const Method method : {Method::kEas, Method::kCrtFriction}) {
    SCOPED_TRACE(static_cast<int>(method));
    const Loads first = Pull(robot, {3, 1, 0.5});
    const Loads loads = Pull(robot, {2.9, 1.1, 0.5});
    const Solution before = SolveCase(robot, first, method);
    const Solution s = SolveFrom(robot, first, before, loads, method);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    const auto response = Respond(robot, loads, method, s);
    ASSERT_TRUE(response);
    // Rows are cut where contacts turn back, to 0.1 um: the last part alone is smooth.
    const auto near = [&](Loads at) {
      at.from = s.from;
      return SolveNear(robot, at, method, s.x);
    };
    const auto shown = [&](const Loads& at, const Solution& a) {
      return Describe(robot, at, method, a).length;
    };
    // Steps that turn no contact by much: 1e-6 N move tendons by 2e-9 m.
    ExpectEqual(response->slope, Differences(robot, loads, method, 1e-6, near, shown), 1e-3);
  }
}

// Two tendons wound, one slack; then three that stretch.
TEST(TdcrResponse, OfWinchesIsThatOfDifferencesOfSolves) {
  Robot robot = Nominal();
  for (const bool stretches : {false, true}) {
    robot.tendon_EA = stretches ? 2000 : 0;
    for (const Method method : {Method::kEas, Method::kCrt}) {
      SCOPED_TRACE(static_cast<int>(method));
      Loads loads = Bent(robot);
      loads.tension.assign(3, 0);
      loads.length = VectorXd::Constant(3, robot.length + (stretches ? -1e-4 : 5e-3));
      loads.length[0] -= stretches ? 2e-3 : 7e-3;
      loads.length[1] -= stretches ? 0 : 6e-3;
      const Solution s = SolveCase(robot, loads, method);
      ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
      Loads at = loads;
      at.tension.assign(s.pull.begin(), s.pull.end());
      const auto response = Respond(robot, at, method, s);
      ASSERT_TRUE(response);
      const MatrixXd expected = Differences(
          robot, loads, method, 1e-6,
          [&](const Loads& moved) { return SolveCase(robot, moved, method); },
          [&](const Loads&, const Solution& a) { return a.pull; });
      ExpectEqual(response->slope, expected, 1e-4);  // of solves to 1e-12 and steps of 1e-6
    }
  }
}

}  // namespace
}  // namespace continuum::tdcr
