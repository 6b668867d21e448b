#include "models/stiff_flop/calibrate.h"

#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"

namespace continuum::stiff_flop {
namespace {

Robot NoLoad() { return Robot::Read(CONTINUUM_SOURCE "/models/stiff_flop/no_load.yaml"); }

std::vector<Case> Pressures(const Robot& robot) {
  std::vector<Case> cases;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(40e3, 0, 0), Eigen::Vector3d(0, 60e3, 0), Eigen::Vector3d(0, 0, 80e3),
        Eigen::Vector3d(50e3, 50e3, 0), Eigen::Vector3d(60e3, 60e3, 60e3)}) {
    cases.push_back({std::to_string(cases.size()), p, {Eigen::Vector3d::Zero(), robot.gravity}});
  }
  return cases;
}

std::vector<statics::MeasuredPoints> TipsOf(const Robot& robot, const Method& method,
                                            const std::vector<Case>& cases, double noise) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, 1);
  std::vector<statics::MeasuredPoints> tips;
  for (const Case& row : cases) {
    Eigen::Vector3d tip = SolveForward(robot.module(), method, row, false).tip;
    for (double& x : tip) x += noise * normal(random);
    tips.push_back({row.label, false, tip});
  }
  return tips;
}

// A braid at 75 deg and a stiffer rubber: tips say both.
TEST(StiffFlopCalibrate, FindsEAndGammaOfTheModelThatMadeTheTips) {
  const Method method = Method::Parse("hooke+elongation+elongation", Direction::kForward);
  const Robot nominal = NoLoad();
  Robot truth = nominal;
  truth.module().E = 150e3;
  truth.module().gamma = 1.309;
  const auto cases = Pressures(nominal);
  const auto tips = TipsOf(truth, method, cases, 0);
  const Calibration c = Calibrate(nominal, method, {"E", "gamma"}, cases, tips, "tips.csv");
  EXPECT_NEAR(c.robot.module().E, 150e3, 15);
  EXPECT_NEAR(c.robot.module().gamma, 1.309, 1e-4);
  EXPECT_LT(c.rmse, 1e-6);
  EXPECT_FALSE(c.poor());
}

TEST(StiffFlopCalibrate, StandardErrorsAreOfTheSizeOfTheErrors) {
  const Method method = Method::Parse("hooke+elongation+fixed", Direction::kForward);
  const Robot nominal = NoLoad();
  const auto cases = Pressures(nominal);
  const auto tips = TipsOf(nominal, method, cases, 0.2e-3);
  const Calibration c = Calibrate(nominal, method, {"E"}, cases, tips, "tips.csv");
  EXPECT_LT(std::abs(c.x[0] - 1), 3 * c.spread.standard[0]);
  EXPECT_LT(c.spread.standard[0], 0.05);
  EXPECT_DOUBLE_EQ(c.level, 5. / 6);
}

TEST(StiffFlopCalibrate, GammaOfABraidThatIsNotModelledIsRefused) {
  const Method method = Method::Parse("hooke+fixed+fixed", Direction::kForward);
  const Robot nominal = NoLoad();
  const auto cases = Pressures(nominal);
  const auto tips = TipsOf(nominal, method, cases, 1e-4);
  try {
    Calibrate(nominal, method, {"gamma"}, cases, tips, "tips.csv");
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("tips that depend on the parameter gamma"));
  }
}

// Tips say E of both, ends of the modules more exactly.
TEST(StiffFlopCalibrate, FindsEOfModulesInSeries) {
  const Method method = Method::Parse("hooke+elongation+elongation", Direction::kForward);
  Robot nominal = NoLoad();
  nominal.series = ModuleSeries({nominal.module(), nominal.module()});
  nominal.names = {"lower", "upper"};
  Robot truth = nominal;
  truth.series.modules[0].E *= 1.4;
  truth.series.modules[1].E *= 0.8;
  std::vector<Case> cases;
  std::vector<statics::MeasuredPoints> tips, ends;
  for (int line = 0; line < 6; line += 2) {
    Case row{std::to_string(line), Eigen::VectorXd::Zero(6), {{}, nominal.gravity}};
    row.load.force.setZero();
    row.given[line] = 40e3;
    const Solution s = SolveForward(truth.series, method, row, false);
    ASSERT_EQ(s.status, Status::kOk);
    ends.push_back({row.label, false, EndsOf(truth.series, method, row, s)});
    tips.push_back(ends.back());
    tips.back().disks.col(0).setConstant(std::numeric_limits<double>::quiet_NaN());
    cases.push_back(row);
  }
  for (const auto* measured : {&tips, &ends}) {
    const Calibration c =
        Calibrate(nominal, method, {"E_lower", "E_upper"}, cases, *measured, "tips.csv");
    EXPECT_NEAR(c.x[0], 1.4, 1e-4);
    EXPECT_NEAR(c.x[1], 0.8, 1e-4);
  }
  EXPECT_THROW(Calibrate(nominal, method, {"E", "E_upper"}, cases, ends, "tips.csv"), Error);
  EXPECT_THROW(Calibrate(nominal, method, {"E_middle"}, cases, ends, "tips.csv"), Error);
}

}  // namespace
}  // namespace continuum::stiff_flop
