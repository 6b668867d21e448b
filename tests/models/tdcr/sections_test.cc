#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/tdcr/details.h"
#include "models/tdcr/fit.h"
#include "models/tdcr/linear_curvature.h"
#include "models/tdcr/mjcf.h"
#include "models/tdcr/model.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"
#include "tests/models/tdcr/rod_in_space.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/tdcr/examples/";

Robot Example(const std::string& name) { return ReadRobot(Yaml::Read(kFolder + name + ".yaml")); }

std::vector<Case> CasesOf(const std::string& name, const Robot& robot) {
  return ReadCases(CsvTable::Read(kFolder + name + ".csv"), robot);
}

// A robot of sections with given stiffness; tendons as lines of YAML.
Robot Made(const std::string& sections, const std::string& tendons) {
  return ReadRobot(Yaml::Parse("format: 1\nrobot: tdcr\nsections:\n" + sections + "tendons:\n" +
                                   tendons + "mu: 0\ngravity: 0\n",
                               "made.yaml"));
}

const std::string kOne =
    "  - {length: 0.2, diameter: 1.0e-3, EI: 4.0e-3, GJ: 3.0e-3, mass_per_length: 0, disks: 10}\n";
const std::string kTwo =
    "  - {length: 0.12, diameter: 1.0e-3, EI: 4.0e-3, GJ: 3.0e-3, mass_per_length: 0, disks: 4}\n"
    "  - {length: 0.08, diameter: 1.0e-3, EI: 1.0e-3, GJ: 8.0e-4, mass_per_length: 0, disks: "
    "[0.01, 0.05, 0.08]}\n";

Solution Solved(const Robot& robot, const Loads& loads, Method method = Method::kCrt) {
  Solution s = SolveCase(robot, loads, method);
  EXPECT_TRUE(s.outcome.ok()) << s.outcome.why;
  return s;
}

double Apart(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return a.cols() == b.cols() ? (a - b).colwise().norm().maxCoeff() : 1e9;
}

class TdcrExample : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Robots, TdcrExample,
                         testing::Values("three_sections", "helical", "converging",
                                         "tube_in_discs"),
                         [](const auto& info) { return std::string(info.param); });

// The solution's base, walked to a tip that must be free. Tolerances: the error of the walk's
// steps.
void ExpectBalanceInSpace(const Robot& robot, const Loads& loads) {
  const Solution s = Solved(robot, loads);
  RodInSpace space(robot, loads, 24);
  space.Walk(s.line.u.col(0));
  EXPECT_LT(Apart(s.disks, space.disks()), 1e-7 * robot.length);
  EXPECT_LT(space.moment().norm(), 1e-6 * robot.moment());
  EXPECT_LT(space.force().norm(), 1e-6 * robot.moment() / robot.length);
}

TEST_P(TdcrExample, IsInBalanceInSpace) {
  const Robot robot = Example(GetParam());
  for (const Case& c : CasesOf(GetParam(), robot)) {
    SCOPED_TRACE(c.name);
    ExpectBalanceInSpace(robot, c.loads);
  }
}

TEST_P(TdcrExample, TakesForcesAndMomentsAtDisks) {
  const Robot robot = Example(GetParam());
  Loads loads = NoLoads(robot);
  loads.tension.assign(loads.tension.size(), 1);
  loads.tension[0] = 3;
  loads.disk_force.setZero(3, robot.disks);
  loads.disk_moment.setZero(3, robot.disks);
  loads.disk_force.col(4) << 0.1, -0.05, 0.02;
  loads.disk_moment.col(6) << 2e-3, 1e-3, 3e-3;
  loads.disk_moment.col(robot.disks - 1) << -1e-3, 2e-3, 1e-3;
  ExpectBalanceInSpace(robot, loads);
}

// What the MJCF of 50 links is off by, at most 1 % of L; the largest is 0.71.
TEST_P(TdcrExample, IsThatOfMuJoCo) {
  const Robot robot = Example(GetParam());
  const auto cases = CasesOf(GetParam(), robot);
  const ModelSpec mjcf = ModelSpec::Load(kFolder + GetParam() + ".xml");
  const Loads& loads = cases[4].loads;
  const Vector3d tip = Solved(robot, loads, Method::kCrtFriction).disks.rightCols<1>();
  EXPECT_LT((PulledTip(mjcf, loads) - tip).norm(), 0.01 * robot.length);
}

TEST_P(TdcrExample, IsTheCommittedMjcf) {
  EXPECT_EQ(ReadFile(kFolder + GetParam() + ".xml"),
            RobotMjcf(Example(GetParam()), 50, Guides::kLinks, GetParam() + std::string(".yaml")));
}

// Lengths of the tendons without friction are the derivatives of the energy by tensions.
TEST_P(TdcrExample, GivenItsTendonsLengthsHasTheirTensions) {
  const Robot robot = Example(GetParam());
  Loads loads = CasesOf(GetParam(), robot)[4].loads;
  loads.mu = 0;
  const Solution pulled = Solved(robot, loads);
  Loads wound = loads;
  wound.length = Describe(robot, loads, Method::kCrt, pulled).length;
  for (std::size_t k = 0; k < loads.tension.size(); ++k) {
    if (loads.tension[k] == 0) wound.length[static_cast<Eigen::Index>(k)] += 0.05;  // slack
  }
  const Solution solution = Solved(robot, wound);
  EXPECT_LT(Apart(solution.disks, pulled.disks), 1e-6 * robot.length);
  for (std::size_t k = 0; k < loads.tension.size(); ++k) {
    EXPECT_NEAR(solution.pull[static_cast<Eigen::Index>(k)], loads.tension[k], 1e-5);
  }
}

TEST_P(TdcrExample, HoldsStillWithFriction) {
  const Robot robot = Example(GetParam());
  Loads loads = CasesOf(GetParam(), robot)[4].loads;
  loads.direction.assign(loads.direction.size(), kAsItSlides);
  const Solution first = Solved(robot, loads, Method::kCrtFriction);
  const Solution again = SolveFrom(robot, loads, first, loads, Method::kCrtFriction);
  ASSERT_TRUE(again.outcome.ok()) << again.outcome.why;
  EXPECT_LT(Apart(first.disks, again.disks), 1e-9);
}

// Tensions along the line against the turns of the tendons through the holes in space, T exp(-mu
// b).
TEST_P(TdcrExample, LosesTensionByTheTurnsOfItsTendons) {
  const Robot robot = Example(GetParam());
  Loads loads = CasesOf(GetParam(), robot)[4].loads;
  loads.mu = 0.3;
  loads.direction.assign(loads.direction.size(), 1);
  const Line line = Solved(robot, loads, Method::kCrtFriction).line;
  const Eigen::Index parts = (line.s.size() - 1) / robot.disks;
  for (int k = 0; k < robot.tendons; ++k) {
    const Route route = robot.RouteOf(k);
    if (route.radius.front() != route.radius.back() && route.end() < robot.disks) continue;  // knee
    std::vector<Vector3d> hole;
    for (Eigen::Index i = 0; i <= route.end() * parts; ++i) {
      const auto disk =
          static_cast<std::size_t>(std::min<Eigen::Index>(i / parts, route.end() - 1));
      const double w =
          static_cast<double>(i) / static_cast<double>(parts) - static_cast<double>(disk);
      const double r = (1 - w) * route.radius[disk] + w * route.radius[disk + 1];
      const double q = (1 - w) * route.angle[disk] + w * route.angle[disk + 1];
      hole.push_back(line.points.col(i) + line.frames[static_cast<std::size_t>(i)] *
                                              Vector3d(r * std::cos(q), r * std::sin(q), 0));
    }
    double turned = 0;
    for (std::size_t i = 1; i + 1 < hole.size(); ++i) {
      const Vector3d a = hole[i] - hole[i - 1], b = hole[i + 1] - hole[i];
      turned += std::atan2(a.cross(b).norm(), a.dot(b));
    }
    // The last place before the tendon ends; half a step at either end is in no polygon.
    const double left = line.tension(route.end() * parts - 1, k);
    const double T = loads.tension[static_cast<std::size_t>(k)];
    EXPECT_NEAR(left, T * std::exp(-loads.mu * turned), 0.01 * T) << "tendon " << k + 1;
  }
}

// A straight rod, so that only the knee and the tilt of the route turn the tendon.
// Curvature that is linear over each section, at all its disks: (8) finds it again.
TEST(TdcrSections, TheShapeFitFindsCurvatureThatIsLinearInEverySection) {
  const Robot robot = ReadRobot(Yaml::Read(kFolder + "tube_in_discs.yaml"));
  const LinearCurvature linear(robot);
  Eigen::VectorXd ends(12);
  ends << 3, -2, 1, 5, 4, -3, -6, 2, 0, 8, -1, 4;
  const Eigen::Matrix3Xd points = linear.Positions(linear.Curvatures(ends));
  const Solution fit = FitShape(robot, points, 0);
  ASSERT_TRUE(fit.outcome.ok()) << fit.outcome.why;
  EXPECT_LT((fit.x / robot.length - ends).norm(), 1e-5);
  EXPECT_LT((fit.disks - points).norm(), 1e-9);
}

TEST(TdcrSections, DerivativesOfDisksByLinearCurvatureAreDifferences) {
  const Robot robot = ReadRobot(Yaml::Read(kFolder + "three_sections.yaml"));
  const LinearCurvature linear(robot);
  const Eigen::VectorXd ends = Eigen::VectorXd::LinSpaced(18, -6, 7);
  const auto gradient = linear.Gradient(linear.Curvatures(ends));
  constexpr double kStep = 1e-4;
  for (Eigen::Index k = 0; k < ends.size(); ++k) {
    Eigen::VectorXd up = ends, down = ends;
    up[k] += kStep, down[k] -= kStep;
    const Eigen::Matrix3Xd slope =
        (linear.Positions(linear.Curvatures(up)) - linear.Positions(linear.Curvatures(down))) /
        (2 * kStep);
    for (int i = 0; i < robot.disks; ++i) {
      EXPECT_LT((gradient[static_cast<std::size_t>(i)].col(k) - slope.col(i)).norm(), 1e-10);
    }
  }
}

TEST(TdcrSections, AKneeOfATendonCostsTensionByItsAngle) {
  const Robot robot =
      Made(kOne, "  - {at: [0, 5, 10], radius: [6.0e-3, 6.0e-3, 4.0e-3], angle: 0}\n");
  Loads loads = NoLoads(robot);
  loads.tension = {1e-6};
  loads.mu = 0.5;
  const Line line = Solved(robot, loads, Method::kCrtFriction).line;
  const Eigen::Index half = (line.s.size() - 1) / 2;
  EXPECT_NEAR(line.tension(half - 1, 0) / 1e-6, 1, 1e-5);
  EXPECT_NEAR(line.tension(half, 0) / 1e-6, std::exp(-0.5 * std::atan(0.02)), 1e-5);
}

TEST(TdcrSections, AnInnerTendonBendsItsSectionToAnArcAndLeavesTheNextStraight) {
  const Robot robot = Made(kTwo, "  - {radius: 6.0e-3, angle: 0, section: 1}\n");
  Loads loads = NoLoads(robot);
  loads.tension = {2};
  const Solution s = Solved(robot, loads);
  const double kappa = 2 * 6e-3 / 4e-3;  // T r/EI
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s.u(0, i), kappa, 1e-9);
  for (int i = 4; i < 7; ++i) EXPECT_NEAR(s.u.col(i).norm(), 0, 1e-9);
  const double bend = 0.12 * kappa;
  const Vector3d tip((1 - std::cos(bend)) / kappa + 0.08 * std::sin(bend), 0,
                     std::sin(bend) / kappa + 0.08 * std::cos(bend));
  EXPECT_LT((s.disks.rightCols<1>() - tip).norm(), 1e-9);
}

TEST(TdcrSections, ATendonOfAllSectionsBendsEachByItsStiffness) {
  const Robot robot = Made(kTwo, "  - {radius: 6.0e-3, angle: 1.5707963267948966}\n");
  Loads loads = NoLoads(robot);
  loads.tension = {1};
  const Solution s = Solved(robot, loads);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(s.u(1, i), 6e-3 / (i < 4 ? 4e-3 : 1e-3), 1e-9);
}

// First order in T: K u = -T a x t of the unbent rod.
TEST(TdcrSections, AHelicalTendonTwistsAndBendsTheRod) {
  const double r = 6e-3, turns = std::numbers::pi / 0.2, T = 1e-4;
  const Robot robot = Made(kOne, "  - {radius: 6.0e-3, angle: [0, 3.141592653589793]}\n");
  Loads loads = NoLoads(robot);
  loads.tension = {T};
  const Solution s = Solved(robot, loads);
  const double along = std::hypot(1, r * turns);
  for (int i = 0; i < 10; ++i) {
    const double angle = turns * (i + 0.5) * 0.02, bend = T * r / (4e-3 * along);
    EXPECT_NEAR(s.u(0, i), bend * std::cos(angle), 1e-3 * bend);
    EXPECT_NEAR(s.u(1, i), bend * std::sin(angle), 1e-3 * bend);
    EXPECT_NEAR(s.u(2, i), -T * r * r * turns / (3e-3 * along), 1e-3 * bend);
  }
}

// In a plane nu = EI kappa - T d|w|/dkappa = 0 with w = (r', 1 - kappa r), here to first order in
// T.
TEST(TdcrSections, AConvergingTendonBendsLessWhereItIsNearer) {
  const double T = 1e-4;
  const Robot robot = Made(kOne, "  - {radius: [10.0e-3, 2.0e-3], angle: 0}\n");
  Loads loads = NoLoads(robot);
  loads.tension = {T};
  const Solution s = Solved(robot, loads);
  for (int i = 0; i < 10; ++i) {
    const double r = 10e-3 - 8e-3 * (i + 0.5) / 10;
    EXPECT_NEAR(s.u(0, i), T * r / 4e-3 / std::hypot(1, 8e-3 / 0.2), 1e-7);
  }
}

TEST(TdcrSections, SmallLoadsAddUp) {
  const Robot robot = Made(kTwo,
                           "  - {radius: 6.0e-3, angle: 0.3, section: 1}\n"
                           "  - {radius: 5.0e-3, angle: [2, 4]}\n");
  const auto tip = [&](double first, double second, double force) {
    Loads loads = NoLoads(robot);
    loads.tension = {first, second};
    loads.tip_force = {0, force, 0};
    return Vector3d(Solved(robot, loads).disks.rightCols<1>() - Vector3d(0, 0, 0.2));
  };
  const double T = 1e-3, F = 1e-5;
  const Vector3d sum = tip(T, 0, 0) + tip(0, T, 0) + tip(0, 0, F);
  EXPECT_LT((tip(T, T, F) - sum).head<2>().norm(), 1e-3 * sum.norm());
}

TEST(TdcrSections, AMomentAtADiskBendsTheRodUpToIt) {
  const Robot robot = Made(kOne, "  - {radius: 6.0e-3, angle: 0}\n");
  Loads loads = NoLoads(robot);
  loads.disk_moment.setZero(3, robot.disks);
  loads.disk_moment.col(5) << 0, 0.02, 0;  // about y: towards x
  const Solution s = Solved(robot, loads);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(s.u(0, i), i < 6 ? 0.02 / 4e-3 : 0, 1e-9);
}

TEST(TdcrSections, APrecurvedTubeRestsInItsShape) {
  const Robot robot = Made(
      "  - {length: 0.2, diameter: 2.0e-3, bore: 1.0e-3, E: 50.0e9, nu: 0.25, density: 0, disks: "
      "10, "
      "precurvature: [3, 4, 0]}\n",
      "  - {radius: 6.0e-3, angle: 0}\n");
  EXPECT_NEAR(robot.EI(), 50e9 * std::numbers::pi / 64 * (16e-12 - 1e-12), 1e-12);
  const Solution s = Solved(robot, NoLoads(robot));
  const double x = (1 - std::cos(0.2 * 5)) / 5;
  EXPECT_LT((s.disks.rightCols<1>() - Vector3d(0.6 * x, 0.8 * x, std::sin(1.0) / 5)).norm(), 1e-9);
  EXPECT_NEAR(Describe(robot, NoLoads(robot), Method::kCrt, s).strain, 0, 1e-12);
}

// A column of two sections buckles at tan(k_1 a) tan(k_2 b) = k_2/k_1, k = sqrt(P/EI).
TEST(TdcrSections, AColumnOfTwoSectionsBucklesAtItsLoad) {
  const Robot robot = Made(kTwo, "  - {radius: 6.0e-3, angle: 0}\n");
  double low = 0.01, high = 0.5;
  for (int i = 0; i < 100; ++i) {
    const double P = (low + high) / 2, k1 = std::sqrt(P / 4e-3), k2 = std::sqrt(P / 1e-3);
    (std::tan(k1 * 0.12) * std::tan(k2 * 0.08) < k2 / k1 ? low : high) = P;
  }
  const auto unstable = [&](double P) {
    Loads loads = NoLoads(robot);
    loads.tip_force = {0, 0, -P};
    return SolveNear(robot, loads, Method::kCrt, Vector3d::Zero()).stability.unstable_directions;
  };
  EXPECT_EQ(unstable(0.998 * low), 0);
  EXPECT_EQ(unstable(1.002 * low), 2);  // in both planes
  Loads loads = NoLoads(robot);
  loads.tip_force = {1e-6, 0, -1.5 * low};
  const Solution bent = Solved(robot, loads);
  EXPECT_TRUE(bent.stability.stable());
  EXPECT_GT(bent.disks(0, robot.disks - 1), 0.05);
}

// Disks that crowd at either end leave a long rod without any.
const std::string kCrowded[] = {"[0.19, 0.191, 0.192, 0.194, 0.195, 0.196, 0.197, 0.198, 0.2]",
                                "[0.001, 0.002, 0.003, 0.004, 0.005, 0.006, 0.007, 0.01, 0.2]"};

Robot RodWithDisks(const std::string& disks) {
  return Made(
      "  - {length: 0.2, diameter: 1.0e-3, EI: 4.0e-3, GJ: 3.0e-3, mass_per_length: 0, disks: " +
          disks + "}\n",
      "  - {radius: 7.0e-3, angle: [0, 1]}\n  - {radius: 7.0e-3, angle: 2}\n");
}

// Euler's load pi^2/4 EI/L^2, wherever the disks are.
TEST(TdcrSections, ALongRodBetweenCrowdedDisksBuckles) {
  const double euler = std::numbers::pi * std::numbers::pi / 4 * 4e-3 / 0.04;
  for (const std::string& disks : kCrowded) {
    const Robot robot = RodWithDisks(disks);
    Loads loads = NoLoads(robot);
    loads.tip_force = {0, 0, -0.99 * euler};
    EXPECT_LT(Solved(robot, loads).disks.topRows<2>().norm(), 1e-9);
    loads.tip_force = {1e-6, 0, -1.05 * euler};
    EXPECT_GT(Solved(robot, loads).disks(0, robot.disks - 1), 0.05);
  }
}

// The tip does not depend on massless disks, also where tensions fall along the rod; 1e-7 L is the
// accuracy of crt, 5e-5 L that of the contacts of rows that remember.
TEST(TdcrSections, DisksWithoutMassAndLoadChangeNothing) {
  const Robot even = RodWithDisks("10");
  Loads loads = NoLoads(even);
  loads.tension = {3, 1};
  loads.tip_force = {0.02, 0.05, -0.03};
  loads.mu = 0.3;
  const auto tip = [](const Solution& s) { return Vector3d(s.disks.rightCols<1>()); };
  for (const std::string& disks : kCrowded) {
    const Robot robot = RodWithDisks(disks);
    for (const Method method : {Method::kCrt, Method::kCrtFriction}) {
      const Vector3d apart = tip(Solved(even, loads, method)) - tip(Solved(robot, loads, method));
      EXPECT_LT(apart.norm(), 1e-7 * even.length);
    }
    Loads slides = loads;
    slides.direction.assign(2, kAsItSlides);
    const Vector3d apart = tip(Solved(even, slides, Method::kCrtFriction)) -
                           tip(Solved(robot, slides, Method::kCrtFriction));
    EXPECT_LT(apart.norm(), 5e-5 * even.length);
  }
}

// A load at a disk, and what the results say of it: disks, lengths and moment in one balance.
TEST(TdcrSections, LoadsAtCrowdedDisksAreInBalance) {
  for (const std::string& disks : kCrowded) {
    const Robot robot = RodWithDisks(disks);
    Loads loads = NoLoads(robot);
    loads.tension = {3, 1};
    loads.disk_force.setZero(3, robot.disks);
    loads.disk_force.col(7) = Vector3d(0.02, 0.05, -0.03);
    loads.disk_moment.setZero(3, robot.disks);
    loads.disk_moment.col(6) = Vector3d(1e-3, 2e-3, 1e-3);
    const Solution s = Solved(robot, loads);
    RodInSpace space(robot, loads, 400);
    space.Walk(s.line.u.col(0));
    EXPECT_LT(Apart(s.disks, space.disks()), 1e-6 * robot.length);
    EXPECT_LT(space.moment().norm(), 1e-6 * robot.moment());
    Loads longer = loads;
    longer.tension[0] += 1e-4;
    Loads pushed = loads;
    pushed.disk_force(0, 7) += 1e-4;
    // Betti: a tension moves the disk as a force there moves the tendon.
    loads.disk_moment.setZero();
    longer.disk_moment.setZero();
    pushed.disk_moment.setZero();
    const Solution at = Solved(robot, loads), pulled = Solved(robot, longer);
    const double moved = pulled.disks(0, 7) - at.disks(0, 7);
    const double drawn =
        TendonLengths(robot, at.line)[0] - TendonLengths(robot, Solved(robot, pushed).line)[0];
    EXPECT_NEAR(drawn / moved, 1, 1e-3);
  }
}

// Tapered rods below their buckling load are solved without following the load.
TEST(TdcrSections, WeightAtTheStiffBaseCountsThere) {
  const Robot robot = ReadRobot(Yaml::Parse(
      "format: 1\nrobot: tdcr\nsections:\n"
      "  - {length: 0.2, diameter: 4.0e-3, EI: 0.5, GJ: 0.4, mass_per_length: 0.1, disks: 5, "
      "disk_mass: 6.0e-3}\n"
      "  - {length: 0.1, diameter: 1.0e-3, EI: 2.0e-3, GJ: 1.5e-3, mass_per_length: 5.0e-3, "
      "disks: 5, disk_mass: 0.2e-3}\n"
      "tendons:\n  - {radius: 6.0e-3, angle: 0}\nmu: 0\ngravity: [0, 0, -9.81]\n",
      "tapered.yaml"));
  Loads loads = NoLoads(robot);
  loads.tension = {0.3};
  ExpectBalanceInSpace(robot, loads);
  EXPECT_LT(Solved(robot, loads).outcome.iterations, 10);
}

// The segment of the paper, written as a robot with one section.
TEST(TdcrSections, OneSectionIsTheSegmentOfThePaper) {
  const std::string folder = std::string(CONTINUUM_SOURCE) + "/models/tdcr/";
  const Robot segment = ReadRobot(Yaml::Read(folder + "tdcr.yaml"));
  Robot same = segment;
  same.sections = segment.Sections();
  for (int k = 0; k < 3; ++k) same.routes.push_back(segment.RouteOf(k));
  for (const Case& c : ReadCases(CsvTable::Read(folder + "cases.csv"), segment)) {
    for (const Method method : {Method::kCrt, Method::kCrtFriction}) {
      EXPECT_LT(Apart(Solved(segment, c.loads, method).disks, Solved(same, c.loads, method).disks),
                1e-12);
    }
  }
}

TEST(TdcrSections, MethodsOfConstantCurvatureRefuseThem) {
  const Robot robot = Made(kTwo, "  - {radius: 6.0e-3, angle: 0}\n");
  EXPECT_THROW(SolveCase(robot, NoLoads(robot), Method::kEas), Error);
  EXPECT_THROW(SolveCase(robot, NoLoads(robot), Method::kPcca), Error);
}

struct Refused {
  const char *name, *section, *tendon, *expected;
};
class TdcrBadSections : public testing::TestWithParam<Refused> {};

TEST_P(TdcrBadSections, AreRefusedWithTheirPlace) {
  const Refused& bad = GetParam();
  const std::string rod =
      "  - {length: 0.2, diameter: 1.0e-3, EI: 4.0e-3, GJ: 3.0e-3, mass_per_length: 0, " +
      std::string(bad.section) + "}\n";
  try {
    Made(rod, "  - {" + std::string(bad.tendon) + "}\n");
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("made.yaml:"));
    EXPECT_THAT(e.what(), testing::HasSubstr(bad.expected));
  }
}

const Refused kRefused[] = {
    {"OutsideItsDisk", "disks: 5, disk_radius: 5.0e-3", "radius: 6.0e-3, angle: 0",
     "within disk 0"},
    {"InsideTheRod", "disks: 5", "radius: [6.0e-3, 0.1e-3], angle: 0", "outside the rod"},
    {"AtTheBase", "disks: 5", "radius: 6.0e-3, angle: 0, disk: 0", "beyond the base"},
    {"NoSuchSection", "disks: 5", "radius: 6.0e-3, angle: 0, section: 2", "from 1 to 1"},
    {"BackwardsKnots", "disks: 5", "radius: 6.0e-3, angle: 0, at: [0, 4, 3]", "rise from 0"},
    {"KnotsEndElsewhere", "disks: 5", "radius: 6.0e-3, angle: 0, disk: 5, at: [0, 4]",
     "where the tendon ends"},
    {"TooManyValues", "disks: 5", "radius: [1.0e-3, 2.0e-3, 3.0e-3], angle: 0", "one value, or 2"},
    {"UnknownKey", "disks: 5", "radius: 6.0e-3, angel: 0", "angel"},
    {"UnknownSectionKey", "disks: 5, modulus: 3", "radius: 6.0e-3, angle: 0", "modulus"},
    {"DiskBeyond", "disks: [0.1, 0.3]", "radius: 6.0e-3, angle: 0", "where the section ends"},
    {"DisksFall", "disks: [0.1, 0.05, 0.2]", "radius: 6.0e-3, angle: 0", "rise"},
    {"BothStiffnesses", "disks: 5, E: 6.0e10", "radius: 6.0e-3, angle: 0", "not both"},
    {"BoreTooWide", "disks: 5, bore: 2.0e-3", "radius: 6.0e-3, angle: 0", "below the diameter"}};
INSTANTIATE_TEST_SUITE_P(Files, TdcrBadSections, testing::ValuesIn(kRefused),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace continuum::tdcr
