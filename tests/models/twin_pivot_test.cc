#include "models/twin_pivot/twin_pivot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "error.h"
#include "models/twin_pivot/joint.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Robot Prototype(const std::string& name) {
  return Robot::Read(CONTINUUM_SOURCE "/models/twin_pivot/" + name + ".yaml");
}

Robot Weightless(Robot robot) {
  robot.m_D = robot.m_NiTi = robot.rho_cable = robot.m_CL = 0;
  return robot;
}

Load Pull(const std::vector<double>& tension, Condition condition = Condition::kV) {
  Load load;
  load.condition = condition;
  load.tension = tension;
  return load;
}

VectorXd Random(int n, double largest, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-largest, largest);
  VectorXd x(n);
  for (double& value : x) value = uniform(generator);
  return x;
}

std::vector<double> RandomTension(int cables, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.5, 10);
  std::vector<double> tension(cables);
  for (double& value : tension) value = uniform(generator);
  return tension;
}

// ---- The robot again, from transforms as the paper writes them and without recursion.

Matrix4d Along(double x) {
  Matrix4d t = Matrix4d::Identity();
  t(0, 3) = x;
  return t;
}

Matrix4d Turn(double angle, const Vector3d& axis) {
  Matrix4d t = Matrix4d::Identity();
  t.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis).matrix();
  return t;
}

// Discs 0..n; no angle may be 0.
std::vector<Matrix4d> Discs(const Robot& robot, const VectorXd& beta) {
  std::vector<Matrix4d> disc = {Matrix4d::Identity()};
  for (int m = 1; m <= beta.size(); ++m) {
    const double b = beta[m - 1];
    const double t = robot.L / b * std::tan(b / 2) + robot.h / 2;
    disc.push_back(disc.back() * Along(t) * Turn(b, Vector3d::UnitZ()) *
                   Turn(m % 2 ? M_PI_2 : -M_PI_2, Vector3d::UnitX()) * Along(t));
  }
  return disc;
}

Vector3d At(const Matrix4d& frame, const Vector3d& p) {
  return (frame * p.homogeneous()).head<3>();
}

Vector3d Hole(const Robot& robot, const std::vector<Matrix4d>& disc, int m, int j, bool distal) {
  const double y = robot.r[j] * std::cos(robot.phi[j]);
  const double z = robot.r[j] * std::sin(robot.phi[j]);
  const double x = (distal ? 0.5 : -0.5) * robot.h;
  return At(disc[m], m % 2 ? Vector3d(x, z, -y) : Vector3d(x, y, z));
}

double CableLength(const Robot& robot, const std::vector<Matrix4d>& disc, int m, int j) {
  return (Hole(robot, disc, m, j, false) - Hole(robot, disc, m - 1, j, true)).norm();
}

struct Body {
  int joint;  ///< the last joint (counted from 1) that moves it
  double mass;
  Vector3d place;
};

std::vector<Body> Bodies(const Robot& robot, const VectorXd& beta) {
  const std::vector<Matrix4d> disc = Discs(robot, beta);
  std::vector<Body> bodies;
  for (int m = 1; m <= beta.size(); ++m) {
    const double b = beta[m - 1];
    const Vector3d centroid(robot.h / 2 + robot.L * (1 - std::cos(b)) / (b * b),
                            robot.L * (b - std::sin(b)) / (b * b), 0);
    bodies.push_back({m, robot.m_NiTi, At(disc[m - 1], centroid)});
    bodies.push_back({m, robot.m_D, disc[m].topRightCorner<3, 1>()});
    for (int j = 0; j < robot.Cables(); ++j) {
      if (m > robot.Anchor(j)) continue;
      const Vector3d from = Hole(robot, disc, m - 1, j, true);
      const Vector3d to = Hole(robot, disc, m, j, false);
      bodies.push_back({m, robot.rho_cable * (to - from).norm(), 0.5 * (from + to)});
      if (m == robot.Anchor(j)) bodies.push_back({m, robot.m_CL, Hole(robot, disc, m, j, true)});
    }
  }
  return bodies;
}

// Elastic energy, work of the cables, of weights (given, not following the cables' lengths), of the
// payload and of a force at the tip.
double Energy(const Robot& robot, const Load& load, const VectorXd& beta,
              const std::vector<Body>& weights) {
  const std::vector<Matrix4d> disc = Discs(robot, beta);
  double energy = 0.5 * robot.rods * robot.E * robot.I_z / robot.L * beta.squaredNorm();
  for (int j = 0; j < robot.Cables(); ++j) {
    for (int m = 1; m <= robot.Anchor(j); ++m) {
      energy += load.tension[j] * CableLength(robot, disc, m, j);
    }
  }
  const std::vector<Body> now = Bodies(robot, beta);
  for (std::size_t i = 0; i < now.size(); ++i) {
    energy -= weights[i].mass * load.gravity.dot(now[i].place);
  }
  const Vector3d tip = disc.back().topRightCorner<3, 1>();
  return energy - tip.dot(load.force + load.payload * load.gravity);
}

VectorXd EnergySlope(const Robot& robot, const Load& load, const VectorXd& beta) {
  const std::vector<Body> weights = Bodies(robot, beta);
  // Fourth order with h = 1e-3: truncation h^4 and rounding 1e-16/h are both near 1e-12 of U.
  const double h = 1e-3;
  VectorXd slope(beta.size());
  for (int m = 0; m < beta.size(); ++m) {
    const auto shifted = [&](double by) {
      VectorXd at = beta;
      at[m] += by;
      return Energy(robot, load, at, weights);
    };
    slope[m] = (8 * (shifted(h) - shifted(-h)) - (shifted(2 * h) - shifted(-2 * h))) / (12 * h);
  }
  return slope;
}

class EveryPrototype : public testing::TestWithParam<const char*> {
 protected:
  Robot robot_ = Prototype(GetParam());
  int n_ = robot_.Joints();
  Load load_ = Pull(RandomTension(robot_.Cables(), 3));
};
INSTANTIATE_TEST_SUITE_P(TwinPivot, EveryPrototype, testing::Values("a", "b", "c"));

// ---- Geometry

TEST(TwinPivotGeometry, StumpffFunctionsAreTheClosedForms) {
  for (const double b : {0.3, -1.0, 2.0, 3.1}) {
    const auto c = Stumpff(b);
    // The closed forms divide rounding of 1e-16 by b^5 at worst.
    const double rounding = 1e-15 / std::pow(std::abs(b), 5) + 1e-15;
    EXPECT_NEAR(c[0], std::cos(b), rounding);
    EXPECT_NEAR(c[1], std::sin(b) / b, rounding);
    EXPECT_NEAR(c[2], (1 - std::cos(b)) / (b * b), rounding);
    EXPECT_NEAR(c[3], (b - std::sin(b)) / std::pow(b, 3), rounding);
    EXPECT_NEAR(c[4], (std::cos(b) - 1 + b * b / 2) / std::pow(b, 4), rounding);
    EXPECT_NEAR(c[5], (std::sin(b) - b + std::pow(b, 3) / 6) / std::pow(b, 5), rounding);
  }
}

TEST(TwinPivotGeometry, NothingHappensAtZeroBend) {
  const Robot robot = Prototype("a");
  const Joint<double> straight(robot, 0.0);
  EXPECT_DOUBLE_EQ(straight.origin.x, robot.L + robot.h);
  EXPECT_DOUBLE_EQ(straight.centre.x, (robot.h + robot.L) / 2);
  EXPECT_DOUBLE_EQ(straight.Length(0.003), robot.L);
  for (const double b : {1e-12, 1e-6, 1e-3}) {
    const Joint<double> bent(robot, b);
    // First terms of the series in b; what follows is smaller by b^2, or rounding.
    const double next = robot.L * b * (b * b + 1e-15);
    EXPECT_NEAR(bent.bend, robot.L * b / 12, next);
    EXPECT_NEAR(bent.centre.y, robot.L * b / 6, next);
    EXPECT_NEAR(bent.Length(0.003), robot.L - 0.003 * b, robot.L * b * b);
  }
}

TEST_P(EveryPrototype, CentreLineEndsWhereThePapersTransformsEnd) {
  const VectorXd beta = Random(n_, 0.3, 1);
  const Vector3d tip = Discs(robot_, beta).back().topRightCorner<3, 1>();
  EXPECT_LT((CentreLine(robot_, beta).back() - tip).norm(), 1e-15);
}

TEST_P(EveryPrototype, CablesAreStraightLinesBetweenTheirHoles) {
  const VectorXd beta = Random(n_, 0.3, 2);
  const auto disc = Discs(robot_, beta);
  const MatrixXd length = CableLengths(robot_, beta);
  for (int j = 0; j < robot_.Cables(); ++j) {
    for (int m = 1; m <= n_; ++m) {
      const double expected = m <= robot_.Anchor(j) ? CableLength(robot_, disc, m, j) : 0;
      EXPECT_NEAR(length(m - 1, j), expected, 1e-16) << "joint " << m << " cable " << j + 1;
    }
  }
}

TEST(TwinPivotGeometry, OddJointsLiftAndEvenOnesTurnTowardZ) {
  const Robot robot = Prototype("a");
  VectorXd beta = VectorXd::Zero(6);
  beta[0] = 0.1;
  EXPECT_GT(CentreLine(robot, beta).back().y(), 1e-3);
  beta << 0, 0.1, 0, 0, 0, 0;
  EXPECT_GT(CentreLine(robot, beta).back().z(), 1e-3);
}

// ---- Balance

TEST_P(EveryPrototype, VirtualWorkIsTheSlopeOfTheEnergyWithoutFriction) {
  robot_.friction = {};
  load_.payload = 0.02;
  load_.force = {0.05, -0.1, 0.2};
  load_.gravity = {3, -8, 4};
  const VectorXd beta = Random(n_, 0.3, 4);
  const auto f = Residual(robot_, load_, Method::kVirtualWork, beta);
  ASSERT_TRUE(f);
  EXPECT_LT((*f + EnergySlope(robot_, load_, beta)).norm(), 1e-11);
}

TEST_P(EveryPrototype, SolutionWithoutFrictionIsStationaryInEnergy) {
  load_.condition = Condition::kI;
  load_.force = {0.05, -0.1, 0.2};
  const Solution solution = Solve(robot_, load_);
  ASSERT_TRUE(solution.outcome.ok());
  EXPECT_LT(EnergySlope(robot_, load_, solution.beta).norm(), 1e-11);
}

TEST_P(EveryPrototype, MomentAtTheTipWorksOnTheTurnOfTheTip) {
  const VectorXd beta = Random(n_, 0.3, 5);
  Load loaded = load_;
  loaded.moment = {1e-3, -2e-3, 3e-3};
  for (const Method method : {Method::kVirtualWork, Method::kPrinted}) {
    const VectorXd by_moment =
        *Residual(robot_, loaded, method, beta) - *Residual(robot_, load_, method, beta);
    const auto disc = Discs(robot_, beta);
    for (int m = 0; m < n_; ++m) {
      const Vector3d axis = disc[m].block<3, 1>(0, 2);
      EXPECT_NEAR(by_moment[m], loaded.moment.dot(axis), 1e-16);
    }
  }
}

TEST_P(EveryPrototype, PrintedBalanceTakesMomentsAboutTheProximalDisc) {
  robot_.friction = {};
  load_.force = {0.05, -0.1, 0.2};
  const VectorXd beta = Random(n_, 0.3, 6);
  const auto disc = Discs(robot_, beta);
  const Vector3d tip = disc.back().topRightCorner<3, 1>();
  const VectorXd f = *Residual(robot_, load_, Method::kPrinted, beta);
  for (int m = 1; m <= n_; ++m) {
    const Vector3d origin = disc[m - 1].topRightCorner<3, 1>();
    const double u = beta[m - 1] / 2;
    Vector3d moment = (tip - origin).cross(load_.force);
    for (const Body& body : Bodies(robot_, beta)) {
      if (body.joint >= m) moment += (body.place - origin).cross(body.mass * load_.gravity);
    }
    double expected = moment.dot(disc[m - 1].block<3, 1>(0, 2)) - robot_.Stiffness() * 2 * u;
    for (int j = 0; j < robot_.Cables(); ++j) {
      if (m > robot_.Anchor(j)) continue;
      const double y = robot_.r[j] * (m % 2 ? std::cos(robot_.phi[j]) : std::sin(robot_.phi[j]));
      expected += load_.tension[j] * (y * std::cos(u) - robot_.h / 2 * std::sin(u));
    }
    EXPECT_NEAR(f[m - 1], expected, 1e-15) << "joint " << m;
  }
}

TEST(TwinPivotBalance, PrintedMethodStiffensByTheTensionOverAQuarterDiscAndATwelfthRod) {
  Robot robot = Weightless(Prototype("b"));
  robot.friction = {};
  const Load load = Pull({5, 5, 5, 5});
  const VectorXd beta = VectorXd::Constant(12, 1e-4);
  const VectorXd more = *Residual(robot, load, Method::kVirtualWork, beta) -
                        *Residual(robot, load, Method::kPrinted, beta);
  const double stiffness = 20 * (robot.h / 4 + robot.L / 12);
  // The next terms of the series are smaller by beta^2 = 1e-8.
  EXPECT_NEAR(more[0] / beta[0], stiffness, 1e-7 * stiffness);
}

TEST_P(EveryPrototype, JacobianIsTheSlopeOfTheBalance) {
  // Wide contacts: central differences with 1e-6 rad need a length far above 1e-6 r = 5e-9 m.
  robot_.eps = 1e-4;
  load_.payload = 0.02;
  load_.force = {0.05, -0.1, 0.2};
  load_.moment = {1e-3, -2e-3, 3e-3};
  const VectorXd beta = Random(n_, 0.2, 7);
  for (const Method method : {Method::kVirtualWork, Method::kPrinted}) {
    const MatrixXd slope = *ResidualSlope(robot_, load_, method, beta);
    const double h = 1e-6;
    for (int m = 0; m < n_; ++m) {
      VectorXd above = beta, below = beta;
      above[m] += h;
      below[m] -= h;
      const VectorXd difference =
          (*Residual(robot_, load_, method, above) - *Residual(robot_, load_, method, below)) /
          (2 * h);
      // (h y/eps)^2/6 = 4e-10 of the friction's slope, some 10 N m/rad.
      EXPECT_LT((slope.col(m) - difference).norm(), 1e-8) << "column " << m + 1;
    }
  }
}

// ---- Limits

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

TEST_P(EveryPrototype, SmallFrictionMovesTheTipLinearly) {
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

TEST_P(EveryPrototype, ConstantCoefficientIsConditionThree) {
  robot_.friction = {0, 0, robot_.mu_const};
  load_.condition = Condition::kII;
  const VectorXd two = Solve(robot_, load_).beta;
  load_.condition = Condition::kIII;
  EXPECT_EQ(two, Solve(robot_, load_).beta);
}

TEST_P(EveryPrototype, ConditionFourIsARobotWithoutRodsCablesAndLocks) {
  load_.condition = Condition::kIV;
  const VectorXd four = Solve(robot_, load_).beta;
  robot_.m_NiTi = robot_.rho_cable = robot_.m_CL = 0;
  load_.condition = Condition::kII;
  EXPECT_EQ(four, Solve(robot_, load_).beta);
}

TEST_P(EveryPrototype, PayloadIsAForceAtTheTipAndCountsInFiveOnly) {
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
  const double e = robot.L * (2 * std::sin(b / 2) / (b * b) - c / b);
  const double y = robot.r[0] * std::cos(robot.phi[0]);
  const double f_up = up / (1 + w), f_low = low / (1 - w);
  // The contact is sharp to exp(-2 DeltaL/eps), nothing at DeltaL = 0.3 mm; phi has eight digits.
  EXPECT_GT(b, 0.05);
  EXPECT_NEAR(solution.tension(0, 0), f_up, 1e-9);
  EXPECT_NEAR(solution.tension(0, 2), f_low, 1e-9);
  EXPECT_NEAR(2 * f_up * (y * c + e) + 2 * f_low * (-y * c + e), robot.Stiffness() * b, 1e-9);
}

// ---- Friction

TEST_P(EveryPrototype, FrictionOpposesTheSlideAtEveryContact) {
  const MatrixXd straight = CableLengths(robot_, VectorXd::Zero(n_));
  for (unsigned seed = 10; seed < 20; ++seed) {
    const Load load = Pull(RandomTension(robot_.Cables(), seed));
    const Solution solution = Solve(robot_, load);
    ASSERT_TRUE(solution.outcome.ok());
    for (int j = 0; j < robot_.Cables(); ++j) {
      double before = load.tension[j];
      for (int m = 0; m < robot_.Anchor(j); ++m) {
        const int rest = robot_.Anchor(j) - m;
        const double change = (solution.length.col(j) - straight.col(j)).segment(m, rest).sum();
        // Rounding of the two factors, each some 1e-15 N and 1e-17 m.
        EXPECT_GE((solution.tension(m, j) - before) * change, -1e-18);
        before = solution.tension(m, j);
      }
    }
  }
}

TEST_P(EveryPrototype, TensionChangesByTheFrictionOfBothSidesOfADisc) {
  const Solution solution = Solve(robot_, load_);
  const MatrixXd straight = CableLengths(robot_, VectorXd::Zero(n_));
  const auto rub = [&](int m, int j) {
    const double theta = std::abs(solution.beta[m]) / 2;
    return robot_.friction.At(theta) * std::sin(theta) * solution.tension(m, j);
  };
  for (int j = 0; j < robot_.Cables(); ++j) {
    for (int m = 0; m < robot_.Anchor(j); ++m) {
      const int rest = robot_.Anchor(j) - m;
      const double change = (solution.length.col(j) - straight.col(j)).segment(m, rest).sum();
      const double before = m == 0 ? load_.tension[j] : solution.tension(m - 1, j);
      const double friction = rub(m, j) + (m == 0 ? 0 : rub(m - 1, j));
      EXPECT_NEAR(solution.tension(m, j) - before, std::tanh(change / robot_.eps) * friction,
                  1e-10);
    }
  }
}

TEST_P(EveryPrototype, StateThatNamesItselfAsReferenceHasNoFriction) {
  const Solution free = Solve(robot_, Pull(load_.tension, Condition::kI));
  load_.condition = Condition::kII;
  load_.reference = free.length;
  EXPECT_LT((Solve(robot_, load_).beta - free.beta).norm(), 1e-9);
}

TEST(TwinPivotFriction, ReleasedRobotStaysMoreBentThanPulledOne) {
  const Robot robot = Prototype("b");
  const Solution far = Solve(robot, Pull({18, 18, 8, 8}));
  Load back = Pull({14, 14, 8, 8});
  const Solution pulled = Solve(robot, back);
  back.reference = far.length;
  const Solution released = Solve(robot, back);
  ASSERT_TRUE(released.outcome.ok());
  EXPECT_GT(released.tip.y(), pulled.tip.y() + 1e-3);
  EXPECT_LT(released.tip.y(), far.tip.y());
}

TEST_P(EveryPrototype, SharpContactsAreTheLimitOfWideOnes) {
  std::vector<Vector3d> tip;
  for (const double eps : {1e-4, 1e-5, 1e-6, 1e-7}) {
    robot_.eps = eps;
    const Solution solution = Solve(robot_, load_);
    ASSERT_TRUE(solution.outcome.ok()) << solution.outcome.why;
    tip.push_back(solution.tip);
  }
  // What is left goes with eps itself; a lever of n joints makes it some times larger.
  EXPECT_LE((tip[2] - tip[3]).norm(), 1e-4);
  EXPECT_LE((tip[2] - tip[3]).norm(), (tip[0] - tip[1]).norm() + 1e-12);
}

TEST_P(EveryPrototype, SolutionDoesNotDependOnTheStart) {
  for (unsigned seed = 100; seed < 400; ++seed) {
    const Load load = Pull(RandomTension(robot_.Cables(), seed));
    const Solution straight = Solve(robot_, load);
    const Solution other = Solve(robot_, load, Method::kVirtualWork, Random(n_, 0.5, seed));
    ASSERT_TRUE(straight.outcome.ok() && other.outcome.ok());
    EXPECT_LE(straight.outcome.residual, 1e-10);
    EXPECT_LT((straight.beta - other.beta).norm(), 1e-9);
  }
}

TEST(TwinPivotFriction, NegativeCoefficientInUseIsBadInput) {
  Robot robot = Prototype("a");
  robot.friction = {0, -5, 0.1};
  EXPECT_THROW(Solve(robot, Pull({10, 10, 1, 1})), Error);
  EXPECT_NO_THROW(Solve(robot, Pull({10, 10, 1, 1}, Condition::kI)));
}

TEST(TwinPivotFriction, ContactThatWouldLockIsOutOfTheDomain) {
  Robot robot = Prototype("a");
  robot.friction = {0, 0, 20};
  const VectorXd beta = VectorXd::Constant(6, 0.2);
  EXPECT_FALSE(Residual(robot, Pull({9, 9, 1, 1}), Method::kVirtualWork, beta));
}

TEST(TwinPivotFriction, HopelessCaseSaysSo) {
  const Solution solution = Solve(Prototype("a"), Pull({1e9, 0, 0, 0}));
  EXPECT_FALSE(solution.outcome.ok());
  EXPECT_FALSE(solution.outcome.why.empty());
}

}  // namespace
}  // namespace continuum::twin_pivot
