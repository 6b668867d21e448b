// ctest labels: slow
#include "models/tdcr/equilibria.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "models/tdcr/details.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

Robot Bare(int disks = 9) {
  Robot robot;
  robot.disks = disks;
  return robot;
}

double Unit(const Robot& robot) { return robot.EI() / (robot.length * robot.length); }

Loads Pushed(const Robot& robot, double size, double angle) {
  Loads loads = NoLoads(robot);
  loads.tip_force = size * Unit(robot) * Vector3d(std::sin(angle), 0, std::cos(angle));
  return loads;
}

/// A rod that no tendon bends lies in the plane of its base's tangent and the force: it is the
/// pendulum theta'' = -P sin(alpha - theta), theta(0) = 0, theta'(1) = 0, in units of L and EI/L^2;
/// alpha: angle of the force from z. Here by Runge and Kutta's formula over the base's curvature.
struct Pendulum {
  double force, alpha;

  struct State {
    double theta = 0, slope = 0, x = 0, z = 0, energy = 0;
  };

  State End(double curvature) const {
    constexpr int kSteps = 400;
    const double h = 1.0 / kSteps;
    State y{0, curvature};
    const auto rate = [&](const State& s) {
      return State{s.slope, -force * std::sin(alpha - s.theta), std::sin(s.theta),
                   std::cos(s.theta), 0.5 * s.slope * s.slope};
    };
    const auto add = [](const State& s, double t, const State& d) {
      return State{s.theta + t * d.theta, s.slope + t * d.slope, s.x + t * d.x, s.z + t * d.z,
                   s.energy + t * d.energy};
    };
    for (int i = 0; i < kSteps; ++i) {
      const State a = rate(y), b = rate(add(y, h / 2, a)), c = rate(add(y, h / 2, b));
      const State d = rate(add(y, h, c));
      y = add(add(add(add(y, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
    }
    return y;
  }

  /// Ends of all equilibria, by bisection between the signs of a fine grid.
  std::vector<State> Equilibria() const {
    std::vector<State> found;
    const double most = 2 * std::sqrt(force) + 1;
    const int grid = 600;
    double before = -most;
    for (int i = 1; i <= grid; ++i) {
      const double after = most * (2.0 * i / grid - 1);
      double low = before, high = after;
      const double sign = End(low).slope;
      if (sign * End(high).slope < 0) {
        for (int k = 0; k < 60; ++k) {
          const double middle = 0.5 * (low + high);
          (sign * End(middle).slope > 0 ? low : high) = middle;
        }
        found.push_back(End(low));
      }
      before = after;
    }
    return found;
  }
};

TEST(TdcrEquilibria, OfARodUnderADeadForceAreThoseOfAPendulum) {
  const Robot robot = Bare();
  for (const double size : {2., 12.}) {  // at 30 and 70 the search misses a saddle or two
    for (const double angle : {1.2, 2.0, 2.9}) {
      const Loads loads = Pushed(robot, size, angle);
      const Solution own = SolveCase(robot, loads, Method::kCrt);
      const auto list = Equilibria(robot, loads, Method::kCrt, own);
      const Pendulum pendulum{size, angle};
      const auto all = pendulum.Equilibria();
      EXPECT_EQ(list.size(), all.size()) << size << " " << angle;
      int stable = 0;
      for (const Solution& s : list) {
        const Vector3d tip = s.disks.rightCols<1>() / robot.length;
        double nearest = 1, energy = 0;
        for (const auto& p : all) {
          const double distance = (tip - Vector3d(p.x, 0, p.z)).norm();
          if (distance > nearest) continue;
          nearest = distance;
          energy = p.energy - size * (p.x * std::sin(angle) + (p.z - 1) * std::cos(angle));
        }
        EXPECT_LT(nearest, 1e-6) << size << " " << angle;
        const double found = Describe(robot, loads, Method::kCrt, s).energy / robot.moment();
        EXPECT_NEAR(found, energy, 1e-5 * (1 + size));  // Simpson's rule over 18 steps or more
        stable += s.stability.stable() ? 1 : 0;
      }
      EXPECT_GE(stable, 1);
      // Morse: minima, saddles and maxima alternate in sum, whatever the load.
      int sum = 0;
      for (const Solution& s : list) sum += s.stability.unstable_directions % 2 == 0 ? 1 : -1;
      EXPECT_EQ(sum, 1) << size << " " << angle;
    }
  }
}

TEST(TdcrEquilibria, TheListBeginsWithTheLeastEnergyAndHoldsTheRisingShape) {
  const Robot robot = Bare();
  Loads loads = Pushed(robot, 12, 2.9);
  loads.tension = {3, 0, 0};
  for (const Method method : {Method::kEas, Method::kPcca, Method::kCrt}) {
    const Solution own = SolveCase(robot, loads, method);
    ASSERT_TRUE(own.outcome.ok());
    const auto list = Equilibria(robot, loads, method, own);
    ASSERT_GE(list.size(), 2u);
    double before = -1e9;
    int rising = 0;
    for (const Solution& s : list) {
      const double energy = Describe(robot, loads, method, s).energy;
      EXPECT_GE(energy, before);
      before = energy;
      rising += s.stability.branch == statics::Branch::kRising ? 1 : 0;
    }
    EXPECT_EQ(rising, 1);
    EXPECT_TRUE(list.front().stability.stable());
  }
}

// A round column may buckle into any plane: one shape stands for all.
TEST(TdcrEquilibria, AFamilyIsListedOnce) {
  const Robot robot = Bare();
  const Loads loads = Pushed(robot, 12, std::numbers::pi);
  const Solution own = SolveCase(robot, loads, Method::kCrt);
  const auto list = Equilibria(robot, loads, Method::kCrt, own);
  ASSERT_EQ(list.size(), 2u);  // 12 is between Euler's first and second load, 2.5 and 22.2
  EXPECT_TRUE(list[0].stability.stable());
  EXPECT_EQ(list[0].stability.branch, statics::Branch::kSymmetric);
  EXPECT_EQ(list[1].stability.unstable_directions, 2);
}

TEST(TdcrEquilibria, ASmallLoadHasOne) {
  const Robot robot = ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml"));
  Loads loads = NoLoads(robot);
  loads.tension = {3, 1, 0.5};
  loads.tip_force = {0.02, 0.05, 0.01};
  for (const int direction : {1, kAsItSlides}) {
    loads.direction.assign(3, direction);
    for (const Method method : {Method::kEas, Method::kPcca, Method::kCrt, Method::kCrtFriction}) {
      const Solution own = SolveCase(robot, loads, method);
      ASSERT_TRUE(own.outcome.ok()) << own.outcome.why;
      EXPECT_EQ(Equilibria(robot, loads, method, own).size(), 1u);
    }
  }
}

}  // namespace
}  // namespace continuum::tdcr
