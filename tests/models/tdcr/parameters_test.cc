#include "models/tdcr/parameters.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/tdcr/calibrate.h"
#include "models/tdcr/calibration_document.h"
#include "models/tdcr/document.h"
#include "sim/io/file.h"
#include "tests/models/tdcr/solve_fixture.h"

namespace continuum::tdcr {
namespace {

using testing::HasSubstr;

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/tdcr/";

Robot Shipped(const std::string& name) { return ReadRobot(Yaml::Read(kFolder + name)); }

// Moderate loads in all directions, weight included.
std::vector<Case> RandomCases(const Robot& robot, int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Case c{std::to_string(i), NoLoads(robot)};
    for (double& t : c.loads.tension) t = 3 * share(random);
    for (double& f : c.loads.tip_force) f = 0.05 * normal(random);
    c.loads.gravity = 9.81 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    cases.push_back(c);
  }
  return cases;
}

std::vector<Measured> ShapesOf(const Robot& truth, const std::vector<Case>& cases, Method method) {
  std::vector<Measured> measured;
  for (const Case& c : cases) {
    Loads loads = c.loads;
    loads.mu = truth.mu;
    const Solution s = SolveCase(truth, loads, method);
    EXPECT_TRUE(s.outcome.ok()) << s.outcome.why;
    measured.push_back({c.name, false, truth.MeasuringToBase().transpose() * s.disks});
  }
  return measured;
}

// Without noise every parameter comes back: differences of 1e-4 leave errors of their square.
void ExpectFound(const Robot& nominal, Method method, const std::vector<std::string>& names,
                 const Eigen::VectorXd& x, int cases) {
  const auto unknowns = ParseUnknowns(names, nominal, method, "test");
  ASSERT_EQ(static_cast<Eigen::Index>(unknowns.size()), x.size());
  const Robot truth = Changed(nominal, unknowns, x);
  const auto all = RandomCases(nominal, cases);
  const auto measured = ShapesOf(truth, all, method);
  const Calibration c =
      Calibrate(nominal, method, unknowns, Match(all, measured, "synthetic"), "synthetic");
  EXPECT_LT((c.x - x).cwiseAbs().maxCoeff(), 1e-5) << c.x.transpose();
  EXPECT_LT(c.explained.rmse(), 1e-6 * nominal.length);
}

TEST(TdcrParameters, OfTheSegmentAreFoundTogether) {
  Eigen::VectorXd x(11);
  x << 0.9, 1.15, 0.7, 1.3, 0.05, -0.03, 0.2, 0.1, -0.05, 0.02, 1.1;
  ExpectFound(Shipped("tdcr.yaml"), Method::kCrt,
              {"E", "GJ", "disk_mass", "density", "precurvature", "angle", "radius"}, x, 12);
}

TEST(TdcrParameters, OfSectionsAreFoundTogether) {
  Eigen::VectorXd x(9);
  x << 0.9, 1.1, 1.05, 0.1, -0.2, 0.15, 0.1, 1.2, 0.05;
  ExpectFound(Shipped("examples/three_sections.yaml"), Method::kCrt,
              {"E", "precurvature_2", "angle_3", "disk_mass_3", "angle_9"}, x, 10);
}

TEST(TdcrParameters, OfATubeInDiscsAreFoundTogether) {
  Eigen::VectorXd x(6);
  x << 0.9, 1.2, 0.8, 1.1, 0.95, 0.12;
  ExpectFound(Shipped("examples/tube_in_discs.yaml"), Method::kCrt,
              {"E", "GJ_2", "density_2", "radius_3", "angle_1"}, x, 10);
}

TEST(TdcrParameters, WhatTheRobotLacksIsRefusedByName) {
  const Robot robot = Shipped("tdcr.yaml");
  const auto message = [&](const std::string& name, Method method) -> std::string {
    try {
      ParseUnknowns({name}, robot, method, "--parameters");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message("mass", Method::kCrt), HasSubstr("'mass'"));
  EXPECT_THAT(message("mu", Method::kCrt), HasSubstr("'mu'"));
  EXPECT_THAT(message("precurvature", Method::kEas), HasSubstr("'precurvature'"));
  EXPECT_THAT(message("E_1", Method::kEas), HasSubstr("'E_1'"));
  EXPECT_THAT(message("angle_4", Method::kEas), HasSubstr("'angle_4'"));
  EXPECT_EQ(message("angle_3", Method::kEas), "");
}

TEST_F(TdcrSolve, CalibratedSectionsAreWrittenIntoTheirFileAndSolveTheShapesAgain) {
  const std::string file = kFolder + "examples/tube_in_discs.yaml";
  const Robot nominal = ReadRobot(Yaml::Read(file));
  const std::vector<std::string> names{"E", "precurvature_1", "angle_1", "radius_3", "GJ_2"};
  const auto unknowns = ParseUnknowns(names, nominal, Method::kCrt, "test");
  Eigen::VectorXd x(8);
  x << 0.9, 1.2, 0.5, 0.1, -0.2, 0.1, 0.95, 1.1;
  const Robot truth = Changed(nominal, unknowns, x);
  const auto cases = RandomCases(nominal, 8);
  const auto measured = ShapesOf(truth, cases, Method::kCrt);
  const auto pairs = Match(cases, measured, "synthetic");
  const Calibration c = Calibrate(nominal, Method::kCrt, unknowns, pairs, "synthetic");
  const auto path = folder_ / "K.yaml";
  WriteDocument(path, CalibrationDocument(Yaml::Read(file), nominal, "crt", c, "test"));
  const Robot read = ReadRobot(Yaml::Read(path));
  for (const Pair& pair : pairs) {
    const Solution s = SolveCase(read, pair.loads->loads, Method::kCrt);
    EXPECT_LT(Errors(read, *pair.measured, s.disks).maxCoeff(), 1e-6 * read.length);
  }
  const Yaml calibration = Yaml::Read(path).At("calibration");
  EXPECT_NEAR(calibration.At("E_1").Number(), 0.9 * 60e9, 1e6);  // of the file
  EXPECT_NEAR(calibration.At("E_2").Number(), 1.2 * 4e-3, 1e-7);
  EXPECT_EQ(calibration.At("interval_with_model_error").At("precurvature_1").Items().size(), 3u);
}

}  // namespace
}  // namespace continuum::tdcr
