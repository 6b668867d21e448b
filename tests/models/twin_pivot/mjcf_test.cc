#include "models/twin_pivot/mjcf.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/mjcf/slow_pull.h"
#include "models/twin_pivot/cases.h"
#include "sim/io/file.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Vector3d;

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/twin_pivot/";

Robot Prototype(const std::string& name) { return Robot::Read(kFolder + name + ".yaml"); }

TEST(TwinPivotMjcf, TheCommittedFileIsTheGeneratedOne) {
  EXPECT_EQ(ReadFile(kFolder + "a.xml"), RobotMjcf(Prototype("a")));
}

TEST(TwinPivotMjcf, WeighsWhatThePaperSays) {
  // All but half of the cables' pieces in the first joint, which hang on the base: 18.5 mg.
  const Robot robot = Prototype("a");
  const double at_base = 4 * robot.rho_cable[0] * robot.L[0] / 2;
  EXPECT_NEAR(1e3 * (ModelSpec::Parse(RobotMjcf(robot)).model().body_subtreemass[0] + at_base),
              14.40, 0.005);
}

TEST(TwinPivotMjcf, PulledSlowlyItsTipIsTheSolversOverTenCases) {
  const Robot robot = Prototype("a");
  const ModelSpec mjcf = ModelSpec::Load(kFolder + "a.xml");
  int compared = 0;
  for (const Case& c : ReadCases(kFolder + "cases.csv", robot)) {
    const int number = std::stoi(c.label);
    const bool chosen = number % 2 == 1 && (number <= 15 || (number > 31 && number <= 36));
    if (!chosen || c.load.condition != Condition::kV) continue;
    const Solution solution = Solve(robot, c.load);
    ASSERT_TRUE(solution.outcome.ok());
    EXPECT_LT((PulledTip(mjcf, c.load) - solution.tip).norm(), 0.5e-3) << c.label;
    ++compared;
  }
  EXPECT_EQ(compared, 10);
}

// Twelve joints sway four times as slowly as six; at the pace of A friction held them 0.8 mm off.
TEST(TwinPivotMjcf, PulledSlowlyTheLongPrototypeIsTheSolversToo) {
  const Robot robot = Prototype("b");
  const ModelSpec mjcf = ModelSpec::Parse(RobotMjcf(robot));
  int compared = 0;
  for (const Case& c : ReadCases(kFolder + "cases.csv", robot)) {
    const int number = std::stoi(c.label);
    if ((number != 16 && number != 37) || c.load.condition != Condition::kV) continue;
    const Solution solution = Solve(robot, c.load);
    ASSERT_TRUE(solution.outcome.ok());
    EXPECT_LT((PulledTip(mjcf, c.load) - solution.tip).norm(), 0.1e-3) << c.label;
    ++compared;
  }
  EXPECT_EQ(compared, 2);
}

// Contacts turn back while it bends over: by the paper's rule, which looks at the whole way, it
// would be 7 mm from there.
TEST(TwinPivotMjcf, AnUprightArmBendsToWhereTheSolversFrictionRemembers) {
  const Robot robot = Prototype("b");
  Load load;
  load.tension = {10, 10, 9, 9};
  load.payload = 0.1;
  const double tilt = 30 * M_PI / 180, azimuth = 260 * M_PI / 180;
  load.gravity = -9.81 * Vector3d(std::cos(tilt), std::sin(tilt) * std::cos(azimuth),
                                  std::sin(tilt) * std::sin(azimuth));
  const Solution solution = Solve(robot, load);
  ASSERT_TRUE(solution.outcome.ok()) << solution.outcome.why;
  EXPECT_GT(solution.parts, 1);
  // It sways as it bends: 2.2 mm off at this pace, 1.0 where the loads rise in 6 s.
  EXPECT_LT((PulledTip(ModelSpec::Parse(RobotMjcf(robot)), load) - solution.tip).norm(), 3e-3);
}

TEST(TwinPivotMjcf, SectionsEndTheirCablesAtTheirLastDisc) {
  Robot robot = Prototype("c");
  robot.friction = {};
  Load load;
  load.tension = {6, 6, 2, 2, 4, 2, 1, 2};
  const Solution solution = Solve(robot, load);
  ASSERT_TRUE(solution.outcome.ok());
  // What the pull leaves (1e-4 rad/s) and the cables' weight at their straight length.
  EXPECT_LT((PulledTip(ModelSpec::Parse(RobotMjcf(robot)), load) - solution.tip).norm(), 1e-4);
}

TEST(TwinPivotMjcf, WithoutFrictionAndWeightsTwoHingesAreAnArcToTheFourthOrder) {
  Robot robot = Prototype("a");
  robot.friction = {};
  robot.m_D = robot.m_NiTi = robot.rho_cable = robot.m_CL = 1e-9;
  Load load;
  load.tension = {8, 8, 2, 2};
  const Solution solution = Solve(robot, load);
  ASSERT_TRUE(solution.outcome.ok());
  const double bend = solution.beta.cwiseAbs().maxCoeff();
  // Lengths differ by L (bend/2)^4 (1/72 - 1/120) a joint, 1e-8 m over the robot, and so do the
  // arms of 20 N over 0.4 N m/rad; the rest is the pull, which ends within 1e-5 of its load.
  EXPECT_GT(bend, 0.1);
  EXPECT_LT((PulledTip(ModelSpec::Parse(RobotMjcf(robot)), load) - solution.tip).norm(), 5e-6);
}

TEST(TwinPivotMjcf, AMomentAtTheTipIsRefused) {
  Load load;
  load.tension = {1, 1, 1, 1};
  load.moment = {0, 0, 1e-3};
  EXPECT_THROW(PulledTip(ModelSpec::Parse(RobotMjcf(Prototype("a"))), load), Error);
}

}  // namespace
}  // namespace continuum::twin_pivot
