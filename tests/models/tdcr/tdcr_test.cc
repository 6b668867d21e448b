// ctest labels: slow
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "models/tdcr/cosserat.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/model.h"
#include "models/tdcr/pieces_energy.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"

namespace continuum::tdcr {

static void PrintTo(Method method, std::ostream* out) {
  *out << (method == Method::kEas ? "eas" : method == Method::kPcca ? "pcca" : "crt");
}

namespace {

const Method kMethods[] = {Method::kEas, Method::kPcca, Method::kCrt};

Robot Bare() {
  Robot robot;
  robot.mu = 0;
  return robot;
}

Robot Heavy() {
  Robot robot;
  robot.density = 6450;
  robot.disk_mass = 0.6e-3;
  robot.mu = 0.2;
  return robot;
}

// A case somewhere in the robot's range: 5 N per tendon, 50 g at the tip, any posture.
Loads Random(const Robot& robot, std::mt19937& random, double tension = 5, double force = 0.5) {
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Eigen::Vector3d(x, y, z).normalized();
  };
  Loads loads = NoLoads(robot);
  for (double& t : loads.tension) t = tension * share(random);
  loads.mu = 0.3 * share(random);
  loads.tip_force = force * share(random) * direction();
  loads.gravity = 9.81 * direction();
  return loads;
}

class EveryMethod : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Tdcr, EveryMethod, testing::ValuesIn(kMethods),
                         testing::PrintToStringParamName());

TEST_P(EveryMethod, WithoutLoadsIsExactlyStraight) {
  const Robot robot = Bare();
  const Solution s = SolveCase(robot, NoLoads(robot), GetParam());
  ASSERT_TRUE(s.outcome.ok());
  EXPECT_EQ(s.u.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(s.disks.topRows<2>().cwiseAbs().maxCoeff(), 0);
  EXPECT_NEAR(s.disks(2, 8), robot.length, 1e-16);
}

TEST_P(EveryMethod, OneTendonMakesTheUniformArcOfTheClosedForm) {
  const Robot robot = Bare();
  Loads loads = NoLoads(robot);
  loads.tension[0] = 6;
  const Solution s = SolveCase(robot, loads, GetParam());
  ASSERT_TRUE(s.outcome.ok());
  const double moment = 6 * robot.tendon_radius;
  for (int i = 0; i < robot.disks; ++i) {
    const double chord = GetParam() == Method::kCrt ? 1 : std::cos(s.u(0, i) * robot.arc() / 2);
    EXPECT_NEAR(robot.EI() * s.u(0, i), moment * chord, 1e-9 * moment);
    EXPECT_NEAR(s.u(1, i), 0, 1e-9);
    EXPECT_NEAR(s.u(2, i), 0, 1e-9);
  }
  const double angle = s.u(0, 0) * robot.length;
  EXPECT_NEAR(s.disks(0, 8), robot.length * (1 - std::cos(angle)) / angle, 1e-9 * robot.length);
  EXPECT_NEAR(s.disks(2, 8), robot.length * std::sin(angle) / angle, 1e-9 * robot.length);
}

TEST_P(EveryMethod, ATurnByAThirdWithTendonsRenamedTurnsTheSolution) {
  const Robot robot = Heavy();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2 * std::numbers::pi / 3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    Loads loads = Random(robot, random);
    loads.direction = {1, -1, 0};
    Loads turned = loads;
    turned.tension = {loads.tension[2], loads.tension[0], loads.tension[1]};
    turned.direction = {0, 1, -1};
    turned.tip_force = turn * loads.tip_force;
    turned.gravity = turn * loads.gravity;
    const Solution a = SolveCase(robot, loads, GetParam());
    const Solution b = SolveCase(robot, turned, GetParam());
    ASSERT_TRUE(a.outcome.ok() && b.outcome.ok());
    EXPECT_LT((turn * a.disks - b.disks).cwiseAbs().maxCoeff(), 1e-8 * robot.length);
  }
}

TEST_P(EveryMethod, AThousandColdStartsOverTheRangeAllConverge) {
  const Robot robot = Heavy();
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Solution s = SolveCase(robot, Random(robot, random), GetParam());
    ASSERT_TRUE(s.outcome.ok()) << "case " << i << ": " << s.outcome.why;
    ASSERT_LE(s.outcome.residual, 1e-9);
    ASSERT_TRUE(s.disks.allFinite());
  }
}

TEST_P(EveryMethod, ConvergesAtTwiceTheRange) {
  const Robot robot = Heavy();
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const Solution s = SolveCase(robot, Random(robot, random, 10, 1), GetParam());
    ASSERT_TRUE(s.outcome.ok()) << "case " << i << ": " << s.outcome.why;
    ASSERT_LE(s.outcome.residual, 1e-9);
  }
}

TEST_P(EveryMethod, AWarmStartGivesTheColdSolution) {
  const Robot robot = Heavy();
  std::mt19937 random(4);
  for (int i = 0; i < 20; ++i) {
    const Loads loads = Random(robot, random, 5, 0.3);
    const Solution cold = SolveCase(robot, loads, GetParam());
    const Solution near = SolveCase(robot, loads.Scaled(0.95), GetParam());
    const Solution warm = SolveCase(robot, loads, GetParam(), &near.x);
    ASSERT_TRUE(warm.outcome.ok());
    EXPECT_LT((warm.disks - cold.disks).cwiseAbs().maxCoeff(), 1e-8 * robot.length);
  }
}

// A column just beyond its critical load with a hint to +x must buckle that way, though the nearly
// straight shape is an equilibrium as well.
TEST_P(EveryMethod, BeyondBucklingTheStableBranchIsTaken) {
  const Robot robot = Bare();
  Loads loads = NoLoads(robot);
  loads.tension[0] = 0.01;
  loads.tip_force = {0, 0, -0.8};
  const Solution s = SolveCase(robot, loads, GetParam());
  ASSERT_TRUE(s.outcome.ok());
  EXPECT_GT(s.disks(0, 8), 0.5 * robot.length);
}

TEST_P(EveryMethod, StrongDeadForcesGiveTheEndOfAFinePath) {
  const Robot robot = Bare();
  std::mt19937 random(5);
  for (int i = 0; i < 10; ++i) {
    const Loads loads = Random(robot, random, 2, 1.2);
    const Solution s = SolveCase(robot, loads, GetParam());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(s.x.size());
    Solution path;
    for (int step = 1; step <= 200; ++step) {
      path = SolveCase(robot, loads.Scaled(step / 200.), GetParam(), &x);
      ASSERT_TRUE(path.outcome.ok());
      x = path.x;
    }
    EXPECT_LT((path.disks - s.disks).cwiseAbs().maxCoeff(), 1e-8 * robot.length);
  }
}

TEST(Tdcr, LinearAndPiecewiseCurvatureAgreeWhereCurvatureIsLinear) {
  const Robot robot = Bare();
  Loads loads = NoLoads(robot);
  loads.tip_force = {1e-4, 0, 0};  // bends by 0.3 mrad: M is linear in s up to its square
  const Solution eas = SolveCase(robot, loads, Method::kEas);
  const Solution pcca = SolveCase(robot, loads, Method::kPcca);
  EXPECT_LT((eas.disks - pcca.disks).cwiseAbs().maxCoeff(), 1e-8 * robot.length);
}

// M_i about the start of arc i acts on the whole arc, so the error falls with the first power of l.
TEST(Tdcr, PiecewiseCurvatureApproachesTheCosseratRodWithMoreDisks) {
  Robot robot = Bare();
  Loads loads = NoLoads(robot);
  loads.tension = {4, 1, 0};
  loads.tip_force = {-0.2, 0.1, 0.05};
  double before = 0;
  for (const int disks : {10, 20, 40, 80}) {
    robot.disks = disks;
    const Solution pcca = SolveCase(robot, loads, Method::kPcca);
    const Solution crt = SolveCase(robot, loads, Method::kCrt);
    const double error = (pcca.disks.col(disks - 1) - crt.disks.col(disks - 1)).norm();
    if (before > 0) {
      EXPECT_NEAR(before / error, 2, 0.1);
    }
    before = error;
  }
}

TEST(Tdcr, FrictionOfPulledTendonsLowersAndOfReleasedOnesRaisesTheBend) {
  const Robot robot = Heavy();
  Loads loads = NoLoads(robot);
  loads.gravity.setZero();
  loads.tension[0] = 4;
  const auto bend = [&](int direction, double mu) {
    loads.direction[0] = direction;
    loads.mu = mu;
    return SolveCase(robot, loads, Method::kPcca).u(0, 8);
  };
  EXPECT_LT(bend(1, 0.2), bend(1, 0));
  EXPECT_GT(bend(-1, 0.2), bend(1, 0));
  EXPECT_EQ(bend(0, 0.2), bend(1, 0));
}

TEST(Tdcr, FrictionRatioSolvesTheImplicitLawOnTheSideOfItsDirection) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> component(-0.4, 0.4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d end(component(random), component(random));
    const Eigen::Vector2d start(component(random), component(random));
    for (const int s : {-1, 1}) {
      const double x = FrictionRatio(end, start, 0.3, s).x;
      EXPECT_NEAR(s * (1 - x), 0.3 * (x * start - end).norm(), 1e-14);
    }
    EXPECT_EQ(FrictionRatio(end, end, 0.3, 1).x, 1);
  }
}

template <int C>
struct ByDifferences {
  const DiskBalance<C>& balance;
  bool operator()(const double* x, double* f) const { return balance(x, f); }
};

template <int C>
void CompareJacobians(double size) {
  const Robot robot = Heavy();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(-1, 1);
  Loads loads = Random(robot, random);
  loads.direction = {1, -1, 0};
  const DiskBalance<C> balance(robot, loads);
  using Balance = DiskBalance<C>;
  typename Balance::Vector x = Balance::Vector::Zero(balance.unknowns()), f = x, g = x;
  for (double& component : x) component = size * share(random);
  typename Balance::Matrix exact = Balance::Matrix::Zero(x.size(), x.size()), rough = exact;
  ASSERT_TRUE(balance.Jacobian(x, f, exact));
  ASSERT_TRUE(numerics::Differences(ByDifferences<C>{balance}, x, 1e-6, g, rough));
  EXPECT_EQ(f, g);
  // Differences of step 1e-6 leave 1e-12 of third derivatives and 1e-10 of rounding.
  EXPECT_LT((exact - rough).cwiseAbs().maxCoeff(), 5e-9);
}

TEST(Tdcr, TheJacobianByHandIsThatOfDifferences) {
  for (const double size : {0.1, 1., 8.}) {  // 8: arcs of more than half a radian, no series
    CompareJacobians<6>(size);
    CompareJacobians<Eigen::Dynamic>(size);
  }
}

TEST(Tdcr, BendingSeriesMeetTheClosedFormsSmoothly) {
  for (const double q : {0., 1e-12, 1e-3, 0.2, 0.24999, 0.25001, 1., 9.}) {
    const Bend b(q);
    const double a = std::sqrt(q);
    EXPECT_NEAR(b.A, q == 0 ? 1 : std::sin(a) / a, 1e-15);
    EXPECT_NEAR(b.B, q == 0 ? 0.5 : 2 * std::pow(std::sin(a / 2) / a, 2), 1e-15);
    const double h = 1e-4;
    if (q < h) continue;
    const Bend up(q + h), down(q - h);  // d/d(a^2) = (d/da)/(2 a)
    EXPECT_NEAR(b.dA, (up.A - down.A) / h, 1e-9);
    EXPECT_NEAR(b.dB, (up.B - down.B) / h, 1e-9);
  }
  EXPECT_NEAR(Bend(0.25 - 1e-14).C, Bend(0.25 + 1e-14).C, 1e-15);
  EXPECT_NEAR(Bend(0.25 - 1e-14).dB, Bend(0.25 + 1e-14).dB, 1e-14);
}

TEST(Tdcr, CurvatureNearZeroChangesTheShapeSmoothly) {
  const Robot robot = Bare();
  Loads loads = NoLoads(robot);
  for (const Method method : kMethods) {
    for (const double t : {1e-12, 1e-8, 1e-4}) {
      loads.tension[0] = t;
      const Solution s = SolveCase(robot, loads, method);
      const double bend = t * robot.tendon_radius * robot.length * robot.length / (2 * robot.EI());
      EXPECT_NEAR(s.disks(0, 8) / bend, 1, 1e-6) << t;
    }
  }
}

// Planar elastica under a tip force across and one along, by quadrature-free shooting of its own:
// EI theta'' = -fx cos(theta) + fz sin(theta), theta(0) = 0, theta'(L) = tendon moment/EI, with RK4
// in 20000 steps and bisection on theta'(0).
Eigen::Vector2d PlanarTip(const Robot& robot, double moment, double fx, double fz) {
  const int steps = 20000;
  const double h = robot.length / steps, EI = robot.EI();
  Eigen::Vector4d end;  // theta, theta', x, z
  const auto slope = [&](const Eigen::Vector4d& y) {
    return Eigen::Vector4d(y[1], (-fx * std::cos(y[0]) + fz * std::sin(y[0])) / EI, std::sin(y[0]),
                           std::cos(y[0]));
  };
  const auto shoot = [&](double start) {
    end = {0, start, 0, 0};
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector4d a = slope(end), b = slope(end + h / 2 * a), c = slope(end + h / 2 * b),
                            d = slope(end + h * c);
      end += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return end[1] - moment / EI;
  };
  double lower = -40, upper = 60;
  for (int i = 0; i < 60; ++i) {
    const double middle = (lower + upper) / 2;
    (shoot(middle) > 0 ? upper : lower) = middle;
  }
  return end.tail<2>();
}

TEST(Tdcr, CosseratTipIsThatOfAnIndependentFineShooting) {
  const Robot robot = Bare();
  Loads loads = NoLoads(robot);
  loads.tension[0] = 3;
  for (const auto& [fx, fz] : {std::pair{0.1, 0.}, {-0.3, 0.}, {0.2, 0.3}, {-0.1, -0.2}}) {
    loads.tip_force = {fx, 0, fz};
    const Solution s = SolveCase(robot, loads, Method::kCrt);
    const Eigen::Vector2d tip = PlanarTip(robot, 3 * robot.tendon_radius, fx, fz);
    EXPECT_NEAR(s.disks(0, 8), tip[0], 1e-7 * robot.length);
    EXPECT_NEAR(s.disks(2, 8), tip[1], 1e-7 * robot.length);
  }
}

TEST(Tdcr, CosseratRodIsWithinItsAccuracyOfFourfoldSteps) {
  const Robot robot = Heavy();
  std::mt19937 random(8);
  for (int i = 0; i < 50; ++i) {
    const Loads loads = Random(robot, random);
    const Solution s = SolveCase(robot, loads, Method::kCrt);
    RodBalance fine(robot, loads, false, 16);
    Eigen::Vector3d x = s.x;
    ASSERT_TRUE(numerics::Newton(fine, x).ok());
    EXPECT_LT((fine.Integrate(x).disks - s.disks).colwise().norm().maxCoeff(), 1e-7 * robot.length);
  }
}

// The equilibrium makes the energy of bending, twisting, tendons and dead forces stationary among
// smooth shapes: curvatures changed by cosines change it by the square only.
// The largest slope along cosines in each curvature, over EI/L.
double LargestSlope(int pieces) {
  Robot robot = Bare();
  robot.disks = pieces;  // the middles of pieces are the quadrature's points
  std::mt19937 random(9);
  Loads loads = Random(robot, random, 3, 0.3);
  loads.gravity.setZero();
  const Solution s = SolveCase(robot, loads, Method::kCrt);
  double largest = 0;
  for (int mode = 0; mode < 12; ++mode) {
    Eigen::Matrix3Xd change = Eigen::Matrix3Xd::Zero(3, pieces);
    for (int i = 0; i < pieces; ++i) {
      change(mode / 4, i) = std::cos(mode % 4 * std::numbers::pi * (i + 0.5) / pieces);
    }
    const double h = 1e-4 / robot.length;
    const double difference = EnergyOfPieces(robot, loads, s.u + h * change) -
                              EnergyOfPieces(robot, loads, s.u - h * change);
    largest = std::max(largest, std::abs(difference) / (2e-4 * robot.moment()));
  }
  return largest;
}

TEST(Tdcr, CosseratEquilibriumIsStationaryInEnergy) {
  const double coarse = LargestSlope(100), fine = LargestSlope(400);
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(coarse / fine, 16, 1);  // what is left is the midpoint rule's error
}

TEST(Tdcr, FrictionAlongTheRodFollowsTheCapstanLaw) {
  const Robot robot = Heavy();
  Loads loads = NoLoads(robot);
  loads.gravity.setZero();
  loads.tension[0] = 4;
  loads.mu = 0.3;
  const Solution s = SolveCase(robot, loads, Method::kCrtFriction);
  ASSERT_TRUE(s.outcome.ok());
  // EI kappa = T r and T' = -mu T kappa: T = T_0/(1 + mu T_0 r s/EI).
  const double k0 = 4 * robot.tendon_radius / robot.EI();
  for (int i = 0; i < robot.disks; ++i) {
    const double at = (i + 0.5) * robot.arc();
    EXPECT_NEAR(s.u(0, i), k0 / (1 + 0.3 * k0 * at), 1e-7 * k0);
  }
}

}  // namespace
}  // namespace continuum::tdcr
