#include "models/twin_pivot/equilibria.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "models/twin_pivot/again.h"
#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/details.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Two discs that bend about crossed axes: every equilibrium can be found on a grid of two angles.
Robot TwoDiscs() {
  Robot robot = Weightless(Prototype("a"));
  robot.discs = {2};
  robot.L = 0.03;  // so soft that a push bends it far
  return robot;
}

Load Pushed(double force) {
  Load load = Pull({3, 2, 2, 2}, Condition::kI);
  load.force = {-force, 0.02 * force, 0.01 * force};
  return load;
}

double EnergyAgain(const Robot& robot, const Load& load, const Vector2d& beta) {
  const VectorXd at = beta;
  return again::Energy(robot, load, at, again::Bodies(robot, at));
}

Vector2d Slope(const Robot& robot, const Load& load, const Vector2d& beta) {
  return again::EnergySlope(robot, load, VectorXd(beta));
}

Matrix2d Hessian(const Robot& robot, const Load& load, const Vector2d& beta) {
  const double h = 1e-4;
  Matrix2d hessian;
  for (int i = 0; i < 2; ++i) {
    const Vector2d step = h * Vector2d::Unit(i);
    hessian.col(i) = (Slope(robot, load, beta + step) - Slope(robot, load, beta - step)) / (2 * h);
  }
  return hessian;
}

int Unstable(const Matrix2d& hessian) {
  const Vector2d values =
      Eigen::SelfAdjointEigenSolver<Matrix2d>(0.5 * (hessian + hessian.transpose())).eigenvalues();
  return static_cast<int>((values.array() < 0).count());
}

// Newton on an energy without recursion, from a grid of angles within 2.4 rad.
std::vector<Vector2d> OnAGrid(const Robot& robot, const Load& load) {
  std::vector<Vector2d> found;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      Vector2d beta(0.8 * i + 1e-3, 0.8 * j + 2e-3);
      bool inside = true;
      Matrix2d hessian;
      for (int k = 0; k < 60 && inside; ++k) {
        hessian = Hessian(robot, load, beta);
        Vector2d step = -hessian.inverse() * Slope(robot, load, beta);
        if (step.norm() > 0.2) step *= 0.2 / step.norm();
        beta += step;
        inside = beta.cwiseAbs().maxCoeff() < 2.9;
        if (step.norm() < 1e-9) break;
      }
      if (!inside || Slope(robot, load, beta).norm() > 1e-9) continue;
      bool known = false;
      for (const Vector2d& f : found) known = known || (f - beta).norm() < 1e-4;
      if (!known) found.push_back(beta);
    }
  }
  return found;
}

// All of the grid are in the list, and all of the list are at rest by the independent energy.
TEST(TwinPivotEquilibria, HoldThoseOfAGridOverAnIndependentEnergy) {
  const Robot robot = TwoDiscs();
  std::size_t most = 0;
  for (const double force : {2., 6.}) {
    const Load load = Pushed(force);
    const Solution own = Solve(robot, load);
    ASSERT_TRUE(own.outcome.ok()) << own.outcome.why;
    const auto list = Equilibria(robot, load, Method::kVirtualWork, own);
    most = std::max(most, list.size());
    for (const Vector2d& beta : OnAGrid(robot, load)) {
      const auto here = [&](const Solution& s) { return (s.beta - beta).norm() < 1e-5; };
      EXPECT_TRUE(std::any_of(list.begin(), list.end(), here)) << force << ": " << beta.transpose();
    }
    const double straight = EnergyAgain(robot, load, Vector2d(1e-9, 1e-9));
    double before = -1e9;
    for (const Solution& s : list) {
      const Vector2d beta = s.beta;
      EXPECT_LT(Slope(robot, load, beta).norm(), 1e-8) << force << ": " << beta.transpose();
      EXPECT_EQ(s.stability.unstable_directions, Unstable(Hessian(robot, load, beta)));
      const double energy = Energy(robot, load, s.beta);
      EXPECT_NEAR(energy, EnergyAgain(robot, load, beta) - straight, 1e-8);
      EXPECT_GE(energy, before);
      before = energy;
    }
  }
  EXPECT_GE(most, 5u);  // what it is about
}

// A prototype that stands upright: minima and saddles alternate in sum, whatever the load.
TEST(TwinPivotEquilibria, OfAnUprightPrototypeObeyMorsesSum) {
  const Robot robot = Prototype("a");
  Load load = Pull({3, 3, 2.9, 2.9}, Condition::kI);
  load.gravity = {-9.81, 0, 0};
  load.force = {-4, 0, 0.01};
  const Solution own = Solve(robot, load);
  ASSERT_TRUE(own.outcome.ok()) << own.outcome.why;
  const auto list = Equilibria(robot, load, Method::kVirtualWork, own);
  EXPECT_GE(list.size(), 3u);
  int sum = 0, rising = 0;
  for (const Solution& s : list) {
    sum += s.stability.unstable_directions % 2 == 0 ? 1 : -1;
    rising += s.stability.branch == statics::Branch::kOther ? 0 : 1;
  }
  EXPECT_EQ(sum, 1);
  EXPECT_EQ(rising, 1);
}

TEST(TwinPivotEquilibria, WithFrictionTheOwnAnswerIsAmongThem) {
  const Robot robot = Prototype("a");
  const Load load = Pull({9, 8, 3, 3}, Condition::kV);
  const Solution own = Solve(robot, load);
  ASSERT_TRUE(own.outcome.ok());
  const auto list = Equilibria(robot, load, Method::kVirtualWork, own);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].stability.branch, statics::Branch::kRising);
}

// Lengths, base wrench and strain from the transforms as the paper writes them.
TEST(TwinPivotDetails, IsThatOfAnIndependentDescription) {
  const Robot robot = Prototype("b");
  Load load = Pull({9, 8, 3, 2}, Condition::kV);
  load.payload = 0.02;
  load.force = {0.1, -0.2, 0.05};
  const Solution s = Solve(robot, load);
  ASSERT_TRUE(s.outcome.ok());
  const statics::Details details = Describe(robot, load, s);
  const auto disc = again::Discs(robot, s.beta);
  const Vector3d tip = disc.back().topRightCorner<3, 1>();
  Vector3d force = load.force + load.payload * load.gravity, moment = tip.cross(force);
  for (const auto& body : again::Bodies(robot, s.beta)) {
    force += body.mass * load.gravity;
    moment += body.place.cross(body.mass * load.gravity);
  }
  EXPECT_LT((details.force - force).norm(), 1e-12);
  EXPECT_LT((details.moment - moment).norm(), 1e-10);  // (1 - cos b)/b^2 there is rounded
  EXPECT_LT((details.tip.toRotationMatrix() - disc.back().topLeftCorner<3, 3>()).norm(), 1e-12);
  for (int j = 0; j < 4; ++j) {
    double length = 0;
    for (int m = 1; m <= robot.Anchor(j); ++m) length += again::CableLength(robot, disc, m, j);
    EXPECT_NEAR(details.length[j], length, 1e-14);
  }
  EXPECT_NEAR(details.strain, 0.4e-3 * s.beta.cwiseAbs().maxCoeff() / robot.L[0], 1e-9);
}

}  // namespace
}  // namespace continuum::twin_pivot
