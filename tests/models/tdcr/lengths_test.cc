#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "models/tdcr/details.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Robot Nominal() { return ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml")); }

Loads Free(const Robot& robot) {
  Loads loads = NoLoads(robot);
  loads.gravity.setZero();
  loads.mu = 0;
  return loads;
}

// One tendon wound, the others slack: an arc of curvature d/(L r) and T = EI kappa/r; with stretch
// c the winch has to take up more, L - l = d = kappa r L (1 + EI c/(r^2 L)) to the first order.
TEST(TdcrLengths, OneWoundTendonMakesAnArc) {
  Robot robot = Nominal();
  Loads loads = Free(robot);
  const double L = robot.length, r = robot.tendon_radius, wound = 2e-3;
  loads.length = VectorXd::Constant(3, L + 5e-3);
  loads.length[0] = L - wound;
  const double kappa = wound / (L * r);
  for (const Method method : {Method::kCrt, Method::kCrtFriction}) {
    const Solution s = SolveCase(robot, loads, method);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    EXPECT_NEAR(s.pull[0], robot.EI() * kappa / r, 1e-6);
    EXPECT_EQ(s.pull[1], 0);
    EXPECT_EQ(s.pull[2], 0);
    EXPECT_NEAR(s.u(0, 4), kappa, 1e-6 * kappa);
    EXPECT_TRUE(s.stability.stable());
  }
  robot.tendon_EA = 500;
  const Solution soft = SolveCase(robot, loads, Method::kCrt);
  ASSERT_TRUE(soft.outcome.ok()) << soft.outcome.why;
  // l = L (1 - kappa r) = (L - d) (1 + T/EA).
  const double T = soft.pull[0], bent = T * r / robot.EI();
  EXPECT_NEAR(L * (1 - bent * r), (L - wound) * (1 + T / robot.tendon_EA), 1e-9);
  EXPECT_LT(T, 0.98 * robot.EI() * kappa / r);
}

// What is wound of every tendon: its length without the tensions along it.
VectorXd Wound(const Robot& robot, const Loads& loads, Method method, const Solution& s) {
  const Line line = LineOf(robot, loads, method, s);
  VectorXd mean = VectorXd::Zero(robot.tendons);  // places are even: the trapezoidal rule
  const Eigen::Index last = line.s.size() - 1;
  for (Eigen::Index i = 0; i < last; ++i) {
    mean += 0.5 / static_cast<double>(last) *
            (line.tension.row(i) + line.tension.row(i + 1)).transpose();
  }
  const VectorXd length = Describe(robot, loads, method, s).length;
  return length.array() / (1 + mean.array() / robot.tendon_EA);
}

// The lengths of shapes that tensions have made give these tensions again, also under loads.
// Without stretch three taut tendons share their tension in no way of their own.
TEST(TdcrLengths, TakeBackWhatTensionsHaveMade) {
  Robot robot = Nominal();
  robot.tendon_EA = 5e3;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1, 1);
  for (const Method method : {Method::kEas, Method::kPcca, Method::kCrt, Method::kCrtFriction}) {
    for (int i = 0; i < 4; ++i) {
      Loads loads = NoLoads(robot);
      for (double& t : loads.tension) t = 1.5 + share(random);
      loads.tip_force = 0.05 * Vector3d(share(random), share(random), share(random));
      loads.gravity = 9.81 * Vector3d(share(random), share(random), share(random)).normalized();
      if (method != Method::kCrtFriction) loads.mu = 0;
      const Solution pulled = SolveCase(robot, loads, method);
      ASSERT_TRUE(pulled.outcome.ok());
      Loads wound = loads;
      wound.length = Wound(robot, loads, method, pulled);
      const Solution s = SolveCase(robot, wound, method);
      ASSERT_TRUE(s.outcome.ok()) << i << ": " << s.outcome.why;
      // Tensions that vary stretch a little otherwise than the trapezoidal rule says.
      const double close = method == Method::kCrtFriction ? 1e-2 : 1e-4;
      EXPECT_LT((s.disks - pulled.disks).colwise().norm().maxCoeff(), close * robot.length) << i;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(s.pull[k], loads.tension[static_cast<std::size_t>(k)], close) << i;
      }
    }
  }
}

// Three tendons shorter than the rod by a share e of it compress it: stretch alone, T = EA e/(1 -
// e), whether the tendons are of steel or of rubber.
TEST(TdcrLengths, EqualWindingIsStretchAlone) {
  for (const double e : {1e-4, 0.02, 0.3}) {
    Robot robot = Nominal();
    robot.tendon_EA = 2 * (1 - e) / e;
    Loads loads = Free(robot);
    loads.length = VectorXd::Constant(3, robot.length * (1 - e));
    for (const Method method : {Method::kEas, Method::kCrt}) {
      const Solution s = SolveCase(robot, loads, method);
      ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(s.pull[k], 2, 1e-8) << e;
      EXPECT_LT(s.disks.col(8).head<2>().norm(), 1e-8);
    }
  }
}

// Held tendons keep a push from buckling the rod that tensions alone would let go.
TEST(TdcrLengths, HeldTendonsStandMoreThanPulledOnes) {
  Robot robot = Nominal();
  robot.tendon_EA = 2e4;
  Loads loads = Free(robot);
  const double euler = 2.467 * robot.EI() / (robot.length * robot.length);
  loads.tip_force = {0, 0, -2 * euler};
  loads.length = VectorXd::Constant(3, robot.length * 0.9999);
  for (const Method method : {Method::kEas, Method::kCrt}) {
    const Solution s = SolveCase(robot, loads, method);
    ASSERT_TRUE(s.outcome.ok()) << s.outcome.why;
    EXPECT_LT(s.disks.col(8).head<2>().norm(), 1e-3 * robot.length);
    EXPECT_TRUE(s.stability.stable());
  }
}

// A row goes on from the winches, tensions and contacts of another.
TEST(TdcrLengths, WindingInRowsIsWindingInOne) {
  const Robot robot = Nominal();
  Loads loads = NoLoads(robot);
  loads.gravity.setZero();
  loads.direction.assign(3, kAsItSlides);
  const VectorXd straight = VectorXd::Constant(3, robot.length);
  const Vector3d target(-4e-3, 3e-3, 3e-3);
  for (const Method method : {Method::kEas, Method::kCrtFriction}) {
    Loads once = loads;
    once.length = straight + target;
    const Solution all = SolveCase(robot, once, method);
    ASSERT_TRUE(all.outcome.ok()) << all.outcome.why;
    Loads before = loads;
    before.length = straight + target / 4;
    Solution state = SolveCase(robot, before, method);
    for (int row = 2; row <= 4; ++row) {
      Loads now = loads;
      now.length = straight + row * target / 4;
      state = SolveFrom(robot, before, state, now, method);
      ASSERT_TRUE(state.outcome.ok()) << row << ": " << state.outcome.why;
      before = now;
    }
    EXPECT_LT((state.disks - all.disks).norm(), 1e-6);
    EXPECT_NEAR(state.pull[0], all.pull[0], 1e-3);
    const Solution held = SolveFrom(robot, before, state, before, method);
    EXPECT_LT((state.disks - held.disks).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace continuum::tdcr
