#include "models/tdcr/mjcf.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/mjcf/slow_pull.h"
#include "models/tdcr/model.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"

namespace continuum::tdcr {
namespace {

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/tdcr/";

Robot Segment() { return ReadRobot(Yaml::Read(kFolder + "tdcr.yaml")); }

ModelSpec Links(const Robot& robot, int links) {
  return ModelSpec::Parse(RobotMjcf(robot, links, Guides::kLinks));
}

Eigen::Vector3d RodTip(const Robot& robot, const Loads& loads, Method method) {
  const Solution rod = SolveCase(robot, loads, method);
  EXPECT_TRUE(rod.outcome.ok()) << rod.outcome.why;
  return rod.disks.rightCols<1>();
}

TEST(TdcrMjcf, TheCommittedFilesAreTheGeneratedOnes) {
  const Robot robot = Segment();
  EXPECT_EQ(ReadFile(kFolder + "tdcr.xml"), RobotMjcf(robot, 45, Guides::kLinks));
  EXPECT_EQ(ReadFile(kFolder + "tdcr_disks.xml"), RobotMjcf(robot, 45, Guides::kDisks));
}

TEST(TdcrMjcf, HangsStraightAndWeighsWhatRodAndDisksWeigh) {
  const Robot robot = Segment();
  const ModelSpec mjcf = ModelSpec::Load(kFolder + "tdcr.xml");
  const double rod = robot.density * robot.area() * robot.length;
  // Half of the first piece belongs to the base.
  const double mass = robot.disks * robot.disk_mass + rod * (1 - 0.5 / 45);
  EXPECT_NEAR(mjcf.model().body_subtreemass[0], mass, 1e-12);
  const Eigen::Vector3d tip = PulledTip(mjcf, NoLoads(robot));
  // Places in the file are rounded to picometres.
  EXPECT_LT((tip - Eigen::Vector3d(0, 0, robot.length)).norm(), 46e-12);
}

// The goal of the model; README.md has the distances, at most a third of it.
TEST(TdcrMjcf, PulledSlowlyItsTipIsThatOfTheRodWithFrictionWithinOnePercent) {
  const Robot robot = Segment();
  const ModelSpec mjcf = ModelSpec::Load(kFolder + "tdcr.xml");
  const auto cases = ReadCases(CsvTable::Read(kFolder + "pulls.csv"), robot);
  EXPECT_EQ(cases.size(), 10);
  for (const Case& c : cases) {
    const Eigen::Vector3d rod = RodTip(robot, c.loads, Method::kCrtFriction);
    EXPECT_LT((PulledTip(mjcf, c.loads) - rod).norm(), 0.01 * robot.length) << c.name;
    // Friction is what is compared: without it the tip would be farther than that.
    EXPECT_GT((RodTip(robot, c.loads, Method::kCrt) - rod).norm(), 0.01 * robot.length) << c.name;
  }
}

TEST(TdcrMjcf, ApproachesTheRodWithTheSquareOfTheLengthOfALink) {
  const Robot robot = Segment();
  const auto cases = ReadCases(CsvTable::Read(kFolder + "pulls.csv"), robot);
  for (const std::size_t i : {0, 5, 9}) {
    const Loads& loads = cases[i].loads;
    const Eigen::Vector3d rod = RodTip(robot, loads, Method::kCrtFriction);
    const double coarse = (PulledTip(Links(robot, 9), loads) - rod).norm();
    const double fine = (PulledTip(Links(robot, 27), loads) - rod).norm();
    // 9 when only the second order counts.
    EXPECT_GT(coarse / fine, 6) << cases[i].name;
  }
}

TEST(TdcrMjcf, WithoutFrictionABeamBendsAsTheClosedForm) {
  Robot robot = Segment();
  robot.gravity.setZero();
  robot.mu = 0;
  Loads loads = NoLoads(robot);
  loads.tip_force = {1e-3, 0, 0};
  const double deflection = 1e-3 * std::pow(robot.length, 3) / (3 * robot.EI());
  const double tip = PulledTip(Links(robot, 45), loads).x();
  // The hinges at the middles of the pieces miss (1/45)^2/4 of it; large rotations (0.02 rad)^2.
  EXPECT_NEAR(tip, deflection, 1e-3 * deflection);
}

// Dead loads in the middle of the arm: forces and moments by motors at the disks.
TEST(TdcrMjcf, LoadsAtDisksMoveTheTipAsThoseOfTheRod) {
  const Robot robot = ReadRobot(Yaml::Read(kFolder + "examples/three_sections.yaml"));
  const auto mjcf =
      ModelSpec::Parse(RobotMjcf(robot, 50, Guides::kLinks, "three_sections.yaml", Loaded::kDisks));
  const auto cases = ReadCases(CsvTable::Read(kFolder + "examples/disk_loads.csv"), robot);
  for (const Case& c : cases) {
    Loads unloaded = c.loads;
    unloaded.disk_force.resize(3, 0);
    unloaded.disk_moment.resize(3, 0);
    const Eigen::Vector3d rod = RodTip(robot, c.loads, Method::kCrtFriction);
    EXPECT_LT((PulledTip(mjcf, c.loads) - rod).norm(), 0.01 * robot.length) << c.name;
    const Eigen::Vector3d without = RodTip(robot, unloaded, Method::kCrtFriction);
    EXPECT_GT((without - rod).norm(), 0.05 * robot.length) << c.name;
  }
}

TEST(TdcrMjcf, LoadsAtDisksNeedMotorsThere) {
  const Robot robot = Segment();
  Loads loads = NoLoads(robot);
  loads.disk_force.setZero(3, robot.disks);
  loads.disk_force(0, 3) = 0.1;
  EXPECT_THROW(PulledTip(Links(robot, 9), loads), Error);
}

TEST(TdcrMjcf, LinksAreAMultipleOfTheDisks) {
  EXPECT_THROW(RobotMjcf(Segment(), 50, Guides::kLinks), Error);
}

}  // namespace
}  // namespace continuum::tdcr
