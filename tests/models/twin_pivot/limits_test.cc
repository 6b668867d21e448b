#include <gtest/gtest.h>

#include <cmath>

#include "models/twin_pivot/again.h"
#include "models/twin_pivot/bench.h"

namespace continuum::twin_pivot {
namespace {

using again::Bodies;
using again::Body;

class LimitsOfPrototype : public EveryPrototype {};
INSTANTIATE_TEST_SUITE_P(TwinPivot, LimitsOfPrototype, testing::Values("a", "b", "c"));

TEST(TwinPivotLimits, StraightWithoutLoadHasTheLengthsOfThePaper) {
  const std::vector<std::pair<const char*, double>> lengths = {
      {"a", 0.073}, {"b", 0.146}, {"c", 0.169}};
  for (const auto& [name, length] : lengths) {
    const Robot robot = Weightless(Prototype(name));
    for (const double tension : {0.0, 8.0}) {
      const std::vector<double> equal(robot.Cables(), tension);
      const Solution solution = Solve(robot, Pull(equal));
      ASSERT_TRUE(solution.outcome.ok());
      // L is given with eight digits: 14 x 5e-11 m.
      EXPECT_LT((solution.tip - Vector3d(length, 0, 0)).norm(), 1e-9);
      // phi is given with eight digits, so angles of some 1e-9 rad remain.
      EXPECT_NEAR(solution.tension(robot.Anchor(0) - 1, 0), tension, 1e-9);
    }
  }
}

TEST(TwinPivotLimits, PrototypesWeighWhatThePaperSays) {
  for (const auto& [name, grams] : {std::pair{"a", 14.40}, std::pair{"b", 25.41}}) {
    const Robot robot = Prototype(name);
    double mass = 0;
    for (const Body& body : Bodies(robot, VectorXd::Constant(robot.Joints(), 1e-5))) {
      mass += body.mass;
    }
    EXPECT_NEAR(1e3 * mass, grams, 0.005);
  }
}

TEST_P(LimitsOfPrototype, SmallFrictionMovesTheTipLinearly) {
  const Friction full = robot_.friction;
  const Vector3d without = Solve(robot_, Pull(load_.tension, Condition::kI)).tip;
  const auto moved = [&](double scale) {
    robot_.friction = {scale * full.a, scale * full.b, scale * full.c};
    return Vector3d(Solve(robot_, Pull(load_.tension, Condition::kII)).tip - without);
  };
  const Vector3d small = moved(1e-4);
  // Second order: another 1e-4.
  EXPECT_GT(small.norm(), 1e-9);
  EXPECT_LT((moved(2e-4) - 2 * small).norm(), 1e-3 * small.norm());
}

TEST_P(LimitsOfPrototype, ConstantCoefficientIsConditionThree) {
  robot_.friction = {0, 0, robot_.mu_const};
  load_.condition = Condition::kII;
  const VectorXd two = Solve(robot_, load_).beta;
  load_.condition = Condition::kIII;
  EXPECT_EQ(two, Solve(robot_, load_).beta);
}

TEST_P(LimitsOfPrototype, ConditionFourIsARobotWithoutRodsCablesAndLocks) {
  load_.condition = Condition::kIV;
  const VectorXd four = Solve(robot_, load_).beta;
  robot_.m_NiTi = robot_.rho_cable = robot_.m_CL = 0;
  load_.condition = Condition::kII;
  EXPECT_EQ(four, Solve(robot_, load_).beta);
}

TEST_P(LimitsOfPrototype, PayloadIsAForceAtTheTipAndCountsInFiveOnly) {
  load_.payload = 0.02;
  const VectorXd payload = Solve(robot_, load_).beta;
  Load force = load_;
  force.condition = Condition::kII;
  const VectorXd ignored = Solve(robot_, force).beta;
  force.force = 0.02 * force.gravity;
  // |f| <= 1e-13 N m over a stiffness of 0.4 N m/rad, summed over the joints.
  EXPECT_LT((payload - Solve(robot_, force).beta).norm(), 1e-10);
  EXPECT_GT((payload - ignored).norm(), 1e-3);
}

// Cables at exact odd multiples of 45 degrees; the files have eight digits.
Robot Symmetric(Robot robot) {
  robot.phi = {-M_PI_4, M_PI_4, 3 * M_PI_4, 5 * M_PI_4};
  return robot;
}

VectorXd Flipped(VectorXd beta, int first) {
  for (int m = first; m < beta.size(); m += 2) beta[m] = -beta[m];
  return beta;
}

TEST(TwinPivotLimits, MirrorInZSwapsLeftAndRightCables) {
  for (const char* name : {"a", "b"}) {
    const Robot robot = Symmetric(Prototype(name));
    const VectorXd one = Solve(robot, Pull({9, 4, 1, 2})).beta;
    const VectorXd other = Solve(robot, Pull({4, 9, 2, 1})).beta;
    // Angles follow from |f| <= 1e-13 N m over a softest stiffness of some 0.01 N m/rad.
    EXPECT_LT((other - Flipped(one, 1)).norm(), 1e-10);
  }
}

TEST(TwinPivotLimits, MirrorInYSwapsUpperAndLowerCablesWithoutWeight) {
  for (const char* name : {"a", "b"}) {
    const Robot robot = Symmetric(Weightless(Prototype(name)));
    const VectorXd one = Solve(robot, Pull({9, 4, 1, 2})).beta;
    const VectorXd other = Solve(robot, Pull({2, 1, 4, 9})).beta;
    EXPECT_LT((other - Flipped(one, 0)).norm(), 1e-10);
  }
}

TEST(TwinPivotLimits, OneJointAloneIsAScalarEquation) {
  Robot robot = Weightless(Prototype("a"));
  robot.discs = {2};
  const double up = 8, low = 2;
  const Solution solution = Solve(robot, Pull({up, up, low, low}));
  ASSERT_TRUE(solution.outcome.ok());
  const double b = solution.beta[0];
  const double w = robot.friction.At(b / 2) * std::sin(b / 2);
  const double c = std::cos(b / 2);
  const double e = robot.L[0] * (2 * std::sin(b / 2) / (b * b) - c / b);
  const double y = robot.r[0] * std::cos(robot.phi[0]);
  const double f_up = up / (1 + w), f_low = low / (1 - w);
  // The contact is sharp to exp(-2 DeltaL/eps), nothing at DeltaL = 0.3 mm; phi has eight digits.
  EXPECT_GT(b, 0.05);
  EXPECT_NEAR(solution.tension(0, 0), f_up, 1e-9);
  EXPECT_NEAR(solution.tension(0, 2), f_low, 1e-9);
  EXPECT_NEAR(2 * f_up * (y * c + e) + 2 * f_low * (-y * c + e), robot.Stiffness() * b, 1e-9);
}

}  // namespace
}  // namespace continuum::twin_pivot
