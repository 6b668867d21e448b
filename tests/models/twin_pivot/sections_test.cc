#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>

#include "error.h"
#include "models/mjcf/slow_pull.h"
#include "models/twin_pivot/again.h"
#include "models/twin_pivot/bench.h"
#include "models/twin_pivot/mjcf.h"
#include "sim/io/file.h"

namespace continuum::twin_pivot {
namespace {

using again::Discs;
using again::EnergySlope;

// Four and three cables, and every value its own in each section.
Robot FourAndThree() {
  Robot robot = Prototype("c");
  robot.discs = {4, 6};
  robot.cables = {4, 3};
  robot.r = {5e-3, 5e-3, 4.5e-3, 5e-3, 4e-3, 4e-3, 4e-3};
  robot.phi = {-0.8, 0.7, 2.4, 3.9, 0.1, 2.2, 4.3};
  robot.L = PerSection(std::vector<double>{6e-3, 8e-3});
  robot.h = PerSection(std::vector<double>{6e-3, 4e-3});
  robot.E = PerSection(std::vector<double>{60e9, 50e9});
  robot.I_z = PerSection(std::vector<double>{2e-14, 1.5e-14});
  robot.rods = PerSection(std::vector<double>{2, 3});
  robot.m_D = PerSection(std::vector<double>{1.4e-3, 0.9e-3});
  robot.m_NiTi = PerSection(std::vector<double>{0.4e-3, 0.3e-3});
  robot.rho_cable = PerSection(std::vector<double>{1.5e-3, 1e-3});
  robot.m_CL = PerSection(std::vector<double>{0.8e-3, 0.5e-3});
  return robot;
}

Load Loaded(const Robot& robot) {
  Load load = Pull(RandomTension(robot.Cables(), 3));
  load.payload = 0.005;
  load.force = {0.01, -0.02, 0.03};
  load.on_discs = {{3, {0.1, 0.2, -0.1}, Eigen::Vector3d::Zero()},
                   {robot.Joints() - 1, {-0.1, 0.1, 0.1}, Eigen::Vector3d::Zero()}};
  load.disc_payload = VectorXd::Zero(robot.Joints());
  load.disc_payload[4] = 0.003;
  return load;
}

TEST(TwinPivotSections, BalanceIsTheSlopeOfAnIndependentEnergy) {
  Robot robot = FourAndThree();
  robot.friction = {};
  Load load = Loaded(robot);
  load.gravity = {3, -8, 4};
  const VectorXd beta = Random(robot.Joints(), 0.3, 4);
  const auto f = Residual(robot, load, Method::kVirtualWork, beta);
  ASSERT_TRUE(f);
  EXPECT_LT((*f + EnergySlope(robot, load, beta)).norm(), 1e-11);
}

TEST(TwinPivotSections, SolutionWithoutFrictionIsStationaryInEnergy) {
  Robot robot = FourAndThree();
  robot.friction = {};
  const Load load = Loaded(robot);
  const Solution s = Solve(robot, load);
  ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
  EXPECT_LT(EnergySlope(robot, load, s.beta).norm(), 1e-11);
}

TEST(TwinPivotSections, StraightLengthIsRodsAndDiscs) {
  const Robot robot = FourAndThree();
  // Half of the fixed disc, three whole ones and a half of 6 mm at the end of the first section.
  const double expected = 4 * 6e-3 + 6 * 8e-3 + (3e-3 + 4 * 6e-3) + (6 * 4e-3 - 2e-3);
  EXPECT_NEAR(robot.Length(), expected, 1e-15);
  const auto discs = Discs(robot, VectorXd::Constant(10, 1e-7));
  for (int m = 0; m <= 10; ++m) EXPECT_NEAR(robot.Place(m), discs[m](0, 3), 1e-12) << m;
}

TEST(TwinPivotSections, OneValueForEachIsOneForAll) {
  const Robot one = Prototype("c");
  Robot each = one;
  for (PerSection Robot::*const value :
       {&Robot::L, &Robot::h, &Robot::E, &Robot::I_z, &Robot::rods, &Robot::m_D, &Robot::m_NiTi,
        &Robot::rho_cable, &Robot::m_CL}) {
    each.*value = PerSection(std::vector<double>{(one.*value)[0], (one.*value)[0]});
  }
  const Load load = Pull(RandomTension(8, 5));
  EXPECT_EQ(Solve(one, load).beta, Solve(each, load).beta);
}

// A load on the last disc is one at the tip; a payload there too.
TEST(TwinPivotSections, LoadsOnTheLastDiscAreThoseAtTheTip) {
  const Robot robot = Prototype("b");
  Load tip = Pull({6, 5, 2, 2}), disc = tip;
  tip.force = {0.02, -0.05, 0.1};
  tip.moment = {1e-3, -2e-3, 3e-3};
  tip.payload = 0.01;
  disc.on_discs = {{12, tip.force, tip.moment}};
  disc.disc_payload = VectorXd::Zero(12);
  disc.disc_payload[11] = 0.01;
  for (const Method method : {Method::kVirtualWork, Method::kPrinted}) {
    const VectorXd beta = Random(12, 0.2, 8);
    const VectorXd f = *Residual(robot, tip, method, beta);
    EXPECT_LT((f - *Residual(robot, disc, method, beta)).norm(), 1e-15);
  }
  // |f| <= 1e-13 N m over a softest stiffness of some 0.01 N m/rad.
  EXPECT_LT((Solve(robot, tip).beta - Solve(robot, disc).beta).norm(), 1e-10);
}

// A moment of fixed direction works on the turn of its own disc, and on no joint beyond it.
TEST(TwinPivotSections, MomentOnADiscWorksOnTheTurnOfThatDisc) {
  const Robot robot = FourAndThree();
  const VectorXd beta = Random(robot.Joints(), 0.3, 5);
  const Load load = Pull(RandomTension(robot.Cables(), 3));
  Load loaded = load;
  const Vector3d moment(1e-3, -2e-3, 3e-3);
  loaded.on_discs = {{5, {0, 0, 0}, moment}};
  const VectorXd by = *Residual(robot, loaded, Method::kVirtualWork, beta) -
                      *Residual(robot, load, Method::kVirtualWork, beta);
  const auto disc = Discs(robot, beta);
  for (int m = 0; m < robot.Joints(); ++m) {
    const Vector3d axis = disc[m].block<3, 1>(0, 2);
    EXPECT_NEAR(by[m], m < 5 ? moment.dot(axis) : 0.0, 1e-16) << m;
  }
}

// Without weight a turn of three cables by 180 degrees about x turns the shape.
TEST(TwinPivotSections, ThreeCablesMirrored) {
  Robot robot = Weightless(Prototype("a"));
  robot.cables = {3};
  robot.r = {5e-3, 5e-3, 5e-3};
  robot.phi = {0, 2 * M_PI / 3, 4 * M_PI / 3};
  const VectorXd one = Solve(robot, Pull({6, 3, 1})).beta;
  const VectorXd mirrored = Solve(robot, Pull({6, 1, 3})).beta;
  for (int m = 0; m < 6; ++m) EXPECT_NEAR(mirrored[m], m % 2 ? -one[m] : one[m], 1e-10) << m;
  for (double& phi : robot.phi) phi += M_PI;
  const VectorXd turned = Solve(robot, Pull({6, 3, 1})).beta;
  EXPECT_LT((turned + one).norm(), 1e-10);
  EXPECT_GT(one.cwiseAbs().minCoeff(), 1e-4);
}

TEST(TwinPivotSections, LengthsOfAPulledShapeGiveItsTensions) {
  Robot robot = FourAndThree();
  robot.friction = {};
  const Load pulled = Pull({4, 4, 0, 0, 2, 0, 0});
  const Solution s = Solve(robot, pulled);
  ASSERT_TRUE(s.outcome.ok());
  Load wound = pulled;
  wound.length = s.length.colwise().sum().transpose();
  for (const int slack : {2, 3, 5, 6}) wound.length[slack] += 2e-3;
  const Solution again = Solve(robot, wound);
  ASSERT_TRUE(again.outcome.ok()) << again.outcome.why;
  EXPECT_LT((again.beta - s.beta).norm(), 1e-8);
  EXPECT_LT((again.pull - VectorXd::Map(pulled.tension.data(), 7)).norm(), 1e-6);
}

TEST(TwinPivotSections, TheMjcfPulledSlowlyEndsAtTheSolversTip) {
  Robot robot = FourAndThree();
  robot.friction = {};
  const Load load = Pull({4, 4, 1, 1, 2, 1, 1});
  const Solution s = Solve(robot, load);
  ASSERT_TRUE(s.outcome.ok());
  EXPECT_LT((PulledTip(ModelSpec::Parse(RobotMjcf(robot)), load) - s.tip).norm(), 2e-4);
}

}  // namespace
}  // namespace continuum::twin_pivot
