// ctest labels: slow
#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "models/tdcr/model.h"
#include "models/tdcr/pieces_energy.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using statics::Branch;

constexpr int kPieces = 27;

Robot Bare(int disks = 9) {
  Robot robot;
  robot.disks = disks;
  return robot;
}

double Unit(const Robot& robot) { return robot.EI() / (robot.length * robot.length); }

Loads Of(const Robot& robot, std::vector<double> tension, const Vector3d& force) {
  Loads loads = NoLoads(robot);
  loads.tension = std::move(tension);
  loads.tip_force = force;
  return loads;
}

// The lowest eigenvalue of the second differences of that energy along cosines in each curvature,
// over that of the straight rod without loads (1).
double LowestStiffness(const Robot& robot, const Loads& loads, const Eigen::Matrix3Xd& u) {
  constexpr int kModes = 4, kCount = 3 * kModes;
  const double step = 2e-3;
  std::vector<Eigen::Matrix3Xd> mode;
  for (int i = 0; i < kCount; ++i) {
    mode.emplace_back(Eigen::Matrix3Xd::Zero(3, kPieces));
    for (int s = 0; s < kPieces; ++s) {
      const double at = (s + 0.5) / kPieces;
      mode.back()(i / kModes, s) = std::sqrt(i % kModes ? 2 : 1) *
                                   std::cos(std::numbers::pi * (i % kModes) * at) / robot.length;
    }
  }
  const auto energy = [&](const Eigen::Matrix3Xd& change) {
    return EnergyOfPieces(robot, loads, u + step * change) / robot.moment();
  };
  const double middle = energy(Eigen::Matrix3Xd::Zero(3, kPieces));
  Eigen::MatrixXd hessian(kCount, kCount);
  std::vector<double> ends;
  for (const auto& m : mode) ends.push_back(energy(m) + energy(-m) - 2 * middle);
  for (int i = 0; i < kCount; ++i) {
    const auto a = static_cast<std::size_t>(i);
    for (int j = 0; j <= i; ++j) {
      const auto b = static_cast<std::size_t>(j);
      const double both = energy(mode[a] + mode[b]) + energy(-mode[a] - mode[b]) - 2 * middle;
      hessian(i, j) = hessian(j, i) =
          i == j ? ends[a] / (step * step) : (both - ends[a] - ends[b]) / (2 * step * step);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues()[0];
}

TEST(TdcrStability, PlanarLoadsEndAtMinimaOfAnIndependentEnergy) {
  const Robot robot = Bare(kPieces);
  const double unit = Unit(robot);
  for (const double tension : {0., 3., 8., 20.}) {
    for (const double size : {3., 12.}) {
      for (int angle = 30; angle < 360; angle += 75) {
        const double a = angle * std::numbers::pi / 180;
        const Vector3d force(size * unit * std::sin(a), 1e-6, size * unit * std::cos(a));
        const Loads loads = Of(robot, {tension, 0, 0}, force);
        const Solution s = SolveCase(robot, loads, Method::kCrt);
        ASSERT_TRUE(s.outcome.ok()) << tension << " " << size << " " << angle;
        EXPECT_EQ(s.stability.unstable_directions, 0);
        // Pieces are equilibria of the rod only to the square of their length, 1/27^2.
        EXPECT_GT(LowestStiffness(robot, loads, s.u), -2e-3)
            << tension << " " << size << " " << angle;
      }
    }
  }
}

// The check of the check: at the nearly straight column it is negative.
TEST(TdcrStability, TheIndependentEnergyKnowsASaddle) {
  const Robot robot = Bare(kPieces);
  const Loads loads = Of(robot, {0, 0, 0}, {0, 0, -3 * Unit(robot)});
  EXPECT_LT(LowestStiffness(robot, loads, Eigen::Matrix3Xd::Zero(3, kPieces)), -0.1);
}

struct Known {
  std::vector<double> tension;
  Vector3d force, tip;
};

// Minima of the energy of 27 pieces followed along the rising load.
TEST(TdcrStability, TipsThatTheRisingLoadReaches) {
  const Known known[] = {
      {{2.01, 2, 2}, {0, 0, -1.962}, {0.0754, 0, -0.0564}},
      {{0, 0, 0}, {0, 1e-5, -0.4727}, {0, 0.0889, 0.0876}},
      {{8, 0, 0}, {-0.6302, 1e-6, -1.0916}, {0.033, 0, -0.0547}},
      {{3, 0, 0}, {-0.3939, 1e-6, -0.6823}, {0.0356, 0.0883, -0.0073}},
      {{5, 0, 0}, {-0.6302, 1e-6, -1.0916}, {0.0468, 0, -0.0548}},
  };
  const Robot robot = Bare();
  for (const Known& k : known) {
    for (const Method method : {Method::kCrt, Method::kCrtFriction}) {
      const Solution s = SolveCase(robot, Of(robot, k.tension, k.force), method);
      ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
      EXPECT_LT((s.disks.col(8) - k.tip).norm(), 1e-3);
      EXPECT_EQ(s.stability.branch, Branch::kRising);
    }
  }
}

TEST(TdcrStability, ASymmetricColumnBucklesToOneSideAndSaysSo) {
  const Robot robot = Bare();
  for (const Method method : {Method::kCrt, Method::kEas, Method::kPcca}) {
    for (const double force : {3., 12.}) {
      const Loads loads = Of(robot, {2, 2, 2}, {0, 0, -force * Unit(robot)});
      const Solution s = SolveCase(robot, loads, method);
      ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
      EXPECT_EQ(s.stability.branch, Branch::kSymmetric);
      EXPECT_GT(s.disks.col(8).head<2>().norm(), 0.05);
    }
  }
}

// Euler's column: a hint of a micronewton decides the side from pi^2/4 EI/L^2 on.
TEST(TdcrStability, TheColumnBucklesAtEulersLoad) {
  const Robot robot = Bare();
  const double euler = std::numbers::pi * std::numbers::pi / 4 * Unit(robot);
  const auto aside = [&](double share) {
    const Loads loads = Of(robot, {0, 0, 0}, {1e-9, 0, -share * euler});
    const Solution s = SolveCase(robot, loads, Method::kCrt);
    EXPECT_TRUE(s.outcome.ok()) << s.outcome.why;
    return s.disks(0, 8) / robot.length;
  };
  EXPECT_LT(aside(0.999), 1e-4);
  EXPECT_GT(aside(1.001), 0.02);  // the post-buckled tip goes with the root of what is beyond
}

TEST(TdcrStability, FrictionOfTheTendonsDoesNotHideASaddle) {
  Robot robot = Bare();
  robot.mu = 0.2;
  const Loads loads = Of(robot, {2.01, 2, 2}, {0, 0, -1.962});
  for (const Method method : {Method::kEas, Method::kPcca, Method::kCrtFriction}) {
    const Solution s = SolveCase(robot, loads, method);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    EXPECT_GT(s.disks(0, 8), 0.06);
    EXPECT_LT(s.disks(2, 8), -0.04);
  }
}

TEST(TdcrStability, AWarmStartAtASaddleFindsTheRisingShape) {
  const Robot robot = Bare();
  const Loads loads = Of(robot, {2.01, 2, 2}, {0, 0, -1.962});
  const Eigen::VectorXd straight = Eigen::VectorXd::Zero(3);
  const Solution s = SolveCase(robot, loads, Method::kCrt, &straight);
  ASSERT_TRUE(s.outcome.ok());
  EXPECT_NEAR(s.disks(2, 8), -0.0564, 1e-3);
}

// Forces that pull along the rod: one Newton from rest ends on the path of the load, which is
// followed in small steps here.
TEST(TdcrStability, HangingLoadsLeadAlongTheirPathAtOnce) {
  const Robot robot = Bare();
  for (const Vector3d& force : {Vector3d(0.05, 0.02, 0.6), {-0.03, 0.04, 2}, {0.02, 0, 5}}) {
    const auto at = [&](double share) {
      return Of(robot, {3 * share, 1 * share, 0}, share * force);
    };
    Eigen::VectorXd x = SolveCase(robot, at(0.02), Method::kCrt).x;
    Solution path;
    for (double share = 0.04; share < 1.01; share += 0.02) {
      path = SolveNear(robot, at(share), Method::kCrt, x);
      ASSERT_TRUE(path.outcome.ok());
      x = path.x;
    }
    const Solution s = SolveCase(robot, at(1), Method::kCrt);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    EXPECT_EQ(s.stability.branch, Branch::kRising);
    EXPECT_LT((s.disks - path.disks).norm(), 1e-6 * robot.length);
    EXPECT_LE(s.outcome.iterations, 15);
  }
}

}  // namespace
}  // namespace continuum::tdcr
