#include "models/tdcr/details.h"

#include <gtest/gtest.h>

#include <cmath>

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

Robot Nominal() { return ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml")); }

// One tendon without friction and weight makes an arc of curvature T r/EI: every length is known.
TEST(TdcrDetails, AnArcHasTheLengthsOfParallelArcs) {
  const Robot robot = Nominal();
  Loads loads = NoLoads(robot);
  loads.gravity.setZero();
  loads.mu = 0;
  loads.tension = {4, 0, 0};
  const Solution s = SolveCase(robot, loads, Method::kCrt);
  const statics::Details details = Describe(robot, loads, Method::kCrt, s);
  const double kappa = 4 * robot.tendon_radius / robot.EI(), L = robot.length;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(details.length[k], L * (1 - kappa * robot.Hole(k).x()), 1e-9 * L);
  }
  EXPECT_NEAR(details.strain, kappa * robot.diameter / 2, 1e-9);
  EXPECT_NEAR(details.energy, L * robot.EI() * kappa * kappa / 2 + 4 * (details.length[0] - L),
              1e-9);
  EXPECT_EQ(details.force.norm(), 0);
  const Line line = LineOf(robot, loads, Method::kCrt, s);
  const double half = kappa * L / 2;  // the last frame is turned by kappa L about y
  EXPECT_NEAR(line.frames.back().w(), std::cos(half), 1e-8);
  EXPECT_NEAR(line.frames.back().y(), std::sin(half), 1e-8);
  EXPECT_NEAR(line.tension(3, 0), 4, 1e-12);
}

// Without friction the energy's slope by a tension is the tendon's length, and by a tip force minus
// the tip's way: so the lengths of a bent and loaded rod follow from energies alone.
TEST(TdcrDetails, LengthsAreSlopesOfTheEnergy) {
  const Robot robot = Nominal();
  Loads loads = NoLoads(robot);
  loads.mu = 0;
  loads.tension = {3, 1, 2};
  loads.tip_force = {0.05, -0.03, 0.02};
  const auto energy = [&](const Loads& at) {
    return Describe(robot, at, Method::kCrt, SolveCase(robot, at, Method::kCrt)).energy;
  };
  const Solution s = SolveCase(robot, loads, Method::kCrt);
  const statics::Details details = Describe(robot, loads, Method::kCrt, s);
  for (std::size_t k = 0; k < 3; ++k) {
    const double step = 1e-3;
    Loads more = loads, less = loads;
    more.tension[k] += step, less.tension[k] -= step;
    EXPECT_NEAR((energy(more) - energy(less)) / (2 * step), details.length[k] - robot.length, 1e-7);
  }
  Loads more = loads, less = loads;
  more.tip_force.x() += 1e-3, less.tip_force.x() -= 1e-3;
  EXPECT_NEAR((energy(more) - energy(less)) / 2e-3, -s.disks(0, 8), 1e-7);
}

// The base carries all weights and the tip force; moments about its origin from the places.
TEST(TdcrDetails, TheBaseCarriesTheDeadLoads) {
  const Robot robot = Nominal();
  Loads loads = NoLoads(robot);
  loads.tension = {3, 1, 2};
  loads.tip_force = {0.05, -0.03, 0.02};
  loads.gravity = {0, 9.81, 0};
  for (const Method method : {Method::kEas, Method::kCrt, Method::kCrtFriction}) {
    const Solution s = SolveCase(robot, loads, method);
    const statics::Details details = Describe(robot, loads, method, s);
    const double mass = 9 * robot.disk_mass + robot.density * robot.area() * robot.length;
    EXPECT_LT((details.force - loads.tip_force - mass * loads.gravity).norm(), 1e-12);
    Vector3d moment = s.disks.col(8).cross(loads.tip_force);
    for (int i = 0; i < 9; ++i) {
      moment += s.disks.col(i).cross(robot.disk_mass * loads.gravity);
      // The rod's weight by the trapezoidal rule between disks.
      const double share = i == 8 ? 0.5 : 1;
      moment +=
          s.disks.col(i).cross(share * robot.density * robot.area() * robot.arc() * loads.gravity);
    }
    EXPECT_LT((details.moment - moment).norm(), 0.02 * moment.norm());
  }
}

}  // namespace
}  // namespace continuum::tdcr
