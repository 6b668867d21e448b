#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "models/tdcr/model.h"
#include "models/tdcr/polygon.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

Loads Random(const Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> share(-1, 1);
  Loads loads = NoLoads(robot);
  for (double& t : loads.tension) t = 2.5 * (1 + share(random));
  loads.tip_force = 0.15 * Vector3d(share(random), share(random), share(random));
  loads.gravity = 9.81 * Vector3d(share(random), share(random), share(random)).normalized();
  loads.mu = 0.25 * (1 + share(random));
  loads.direction = {1, -1, 0};
  return loads;
}

TEST(TdcrFriction, TheRodIsThatOfAnIndependentPolygon) {
  Robot robot = ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml"));
  std::mt19937 random(17);
  for (int i = 0; i < 5; ++i) {
    Loads loads = Random(robot, random);
    if (i % 2 == 0) loads.direction = {1, 1, 1};
    const Solution s = SolveCase(robot, loads, Method::kCrtFriction);
    ASSERT_TRUE(s.outcome.ok());
    // The polygon's error falls with the square of its pieces: two of them give the limit.
    const Eigen::Matrix3Xd coarse = Polygon(robot, loads, 40).Disks();
    const Eigen::Matrix3Xd fine = Polygon(robot, loads, 80).Disks();
    const double last = (coarse - s.disks).norm(), now = (fine - s.disks).norm();
    EXPECT_NEAR(last / now, 4, 0.1);
    const Eigen::Matrix3Xd limit = (4 * fine - coarse) / 3;
    EXPECT_LT((limit - s.disks).colwise().norm().maxCoeff(), 1e-7 * robot.length);
    // What it is about: friction moves the tip by far more than that.
    Loads without = loads;
    without.mu = 0;
    const Solution smooth = SolveCase(robot, without, Method::kCrtFriction);
    EXPECT_GT((smooth.disks - s.disks).norm(), 1e-4 * robot.length);
  }
}

}  // namespace
}  // namespace continuum::tdcr
