// ctest labels: slow
#include "models/tdcr/calibrate.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "models/tdcr/model.h"

namespace continuum::tdcr {
namespace {

constexpr int kSets = 60, kCases = 20;
constexpr double kNoise = 0.5e-3;

std::vector<Case> RandomCases(const Robot& robot) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Case> cases;
  for (int i = 0; i < kCases; ++i) {
    Case c{std::to_string(i), NoLoads(robot)};
    for (double& t : c.loads.tension) t = 5 * share(random);
    for (double& f : c.loads.tip_force) f = 0.2 * normal(random);
    cases.push_back(c);
  }
  return cases;
}

// Only the tip is measured, with noise.
std::vector<Measured> Tips(const Robot& truth, const std::vector<Eigen::Vector3d>& tips,
                           std::mt19937_64& random) {
  std::normal_distribution<double> noise(0, kNoise);
  std::vector<Measured> measured;
  for (const Eigen::Vector3d& tip : tips) {
    Measured m{std::to_string(measured.size()), false,
               Eigen::Matrix3Xd::Constant(3, truth.disks, NAN)};
    m.disks.rightCols<1>() = truth.MeasuringToBase().transpose() * tip;
    for (double& x : m.disks.rightCols<1>().reshaped()) x += noise(random);
    measured.push_back(m);
  }
  return measured;
}

// E, the base's rotation and mu lie within two standard errors about as often as 95 in 100: over 60
// sets chance alone leaves less than 50 of them only once in 2000 times.
TEST(TdcrCalibrate, StandardErrorsCoverTheTruthOfNoisyTips) {
  const Robot nominal = ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml"));
  Robot truth = nominal;
  truth.E = 52e9;
  truth.mu = 0.13;
  truth.base_rotation = {0.02, -0.03, 0.05};
  const std::vector<Case> cases = RandomCases(nominal);
  std::vector<Eigen::Vector3d> tips;
  for (const Case& c : cases) {
    Loads loads = c.loads;
    loads.mu = truth.mu;
    tips.push_back(SolveCase(truth, loads, Method::kEas).disks.rightCols<1>());
  }
  const Eigen::Matrix<double, 5, 1> unit{nominal.E, 1, 1, 1, 1};
  Eigen::Matrix<double, 5, 1> target, covered = Eigen::Matrix<double, 5, 1>::Zero();
  target << truth.E, truth.base_rotation, truth.mu;
  std::mt19937_64 random(100);
  for (int i = 0; i < kSets; ++i) {
    const auto measured = Tips(truth, tips, random);
    const Calibration c =
        Calibrate(nominal, Method::kEas, Match(cases, measured, "synthetic"), "synthetic");
    Eigen::Matrix<double, 5, 1> found;
    found << c.robot.E, c.robot.base_rotation, c.robot.mu;
    covered.array() +=
        ((found - target).array().abs() < 2 * (c.spread.standard.array() * unit.array()))
            .cast<double>();
  }
  for (const double count : covered) EXPECT_GE(count, 50);
}

// Shapes of the rod with friction, 0.04 mm of noise: that model finds E and mu again, where models
// without it take friction for stiffness.
TEST(TdcrCalibrate, TheRodWithFrictionFindsItsFriction) {
  Robot nominal = ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml"));
  Robot truth = nominal;
  truth.E = 51e9;
  truth.mu = 0.15;
  const std::vector<Case> cases = RandomCases(nominal);
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 4e-5);
  std::vector<Measured> measured;
  for (const Case& c : cases) {
    Loads loads = c.loads;
    loads.mu = truth.mu;
    const Solution s = SolveCase(truth, loads, Method::kCrtFriction);
    ASSERT_TRUE(s.outcome.ok());
    measured.push_back({c.name, false, s.disks});
    for (double& x : measured.back().disks.reshaped()) x += noise(random);
  }
  nominal.E = 60e9;
  nominal.mu = 0.1;
  const Calibration c =
      Calibrate(nominal, Method::kCrtFriction, Match(cases, measured, "synthetic"), "synthetic");
  EXPECT_NEAR(c.robot.E, truth.E, 1e-3 * truth.E);
  EXPECT_NEAR(c.robot.mu, truth.mu, 2e-3);
  EXPECT_LT(std::abs(c.robot.E - truth.E), 3 * c.spread.standard[0] * nominal.E);
  EXPECT_LT(std::abs(c.robot.mu - truth.mu), 3 * c.spread.standard[4]);
}

}  // namespace
}  // namespace continuum::tdcr
