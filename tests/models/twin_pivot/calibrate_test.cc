#include "models/twin_pivot/calibrate.h"

#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "models/twin_pivot/solve_fixture.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"

namespace continuum::twin_pivot {
namespace {

using testing::HasSubstr;

class TwinPivotCalibrate : public TwinPivotSolve {
 protected:
  TwinPivotCalibrate() {
    request_.calibrate = true;
    request_.out = folder_ / "fit.json";
  }
};

// The paper's rig: five angles, four weights.
std::string Rig(const Friction& friction, double noise) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal(0, noise);
  std::string text = "m,F_SC,theta\n";
  for (const double degrees : {1, 3, 5, 7, 9}) {
    for (const double mass : {0.3035, 0.3535, 0.4035, 0.5035}) {
      const double theta = degrees * M_PI / 180;
      const double mu = friction.At(theta) + normal(generator);
      const double sensor = 9.81 * mass * (1 + mu * std::sin(theta));
      text += Decimal(mass) + "," + Decimal(sensor) + "," + Decimal(theta) + "\n";
    }
  }
  return text;
}

TEST_F(TwinPivotCalibrate, FindsTheCoefficientsThatMadeTheData) {
  Cases(Rig({16.7, -0.2, 0.14}, 0));
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const auto fit = nlohmann::json::parse(ReadFile(request_.out));
  // mu carries rounding of some 1e-16/sin(1 deg); a is its second difference over 0.14 rad.
  EXPECT_NEAR(fit["a"].get<double>(), 16.7, 1e-10);
  EXPECT_NEAR(fit["b"].get<double>(), -0.2, 1e-11);
  EXPECT_NEAR(fit["c"].get<double>(), 0.14, 1e-12);
  EXPECT_LT(fit["rms"].get<double>(), 1e-13);
  EXPECT_EQ(fit["n"], 20);
}

TEST_F(TwinPivotCalibrate, StandardErrorsAreThoseOfTheNormalEquations) {
  const std::vector<double> theta = {0.02, 0.05, 0.09, 0.12, 0.16};
  const std::vector<double> mu = {0.15, 0.17, 0.29, 0.36, 0.58};
  const FrictionFit fit = FitFriction(theta, mu);
  Eigen::MatrixXd x(5, 3);
  Eigen::VectorXd y(5);
  for (int i = 0; i < 5; ++i) {
    x.row(i) << theta[i] * theta[i], theta[i], 1;
    y[i] = mu[i];
  }
  const Eigen::Matrix3d inverse = (x.transpose() * x).inverse();
  const Eigen::Vector3d best = inverse * x.transpose() * y;
  const double ssr = (y - x * best).squaredNorm();
  // The normal matrix squares a condition number of 1e3.
  EXPECT_NEAR(fit.value.a, best[0], 1e-8);
  EXPECT_NEAR(fit.stderror.a, std::sqrt(inverse(0, 0) * ssr / 2), 1e-8);
  EXPECT_NEAR(fit.stderror.b, std::sqrt(inverse(1, 1) * ssr / 2), 1e-9);
  EXPECT_NEAR(fit.stderror.c, std::sqrt(inverse(2, 2) * ssr / 2), 1e-10);
  EXPECT_NEAR(fit.rms, std::sqrt(ssr / 5), 1e-12);
}

TEST_F(TwinPivotCalibrate, NoisyCoefficientsAreWithinFourStandardErrors) {
  Cases(Rig({16.7, 0, 0.14}, 0.02));
  const FrictionFit fit = CalibrateFriction(request_.input);
  EXPECT_NEAR(fit.value.a, 16.7, 4 * fit.stderror.a);
  EXPECT_NEAR(fit.value.c, 0.14, 4 * fit.stderror.c);
}

TEST_F(TwinPivotCalibrate, BadDataAreRefused) {
  const std::string head = "theta,m,F_SC\n";
  const std::string row = "0.1,0.3,3.1\n";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {head + row + row + "0.2,0.3,3.2\n" + "0.2,0.3,3.2\n", "three different angles"},
      {head + row + "0.2,0.3,3.2\n0.3,0.3,3.3\n", "four rows"},
      {head + row + "0,0.3,3.2\n", "cases.csv:3, column 'theta'"},
      {head + row + "-0.1,0.3,3.2\n", "cases.csv:3, column 'theta'"},
      {head + "0.1,0,3.1\n", "column 'm'"},
      {head + "0.1,0.3,-1\n", "column 'F_SC'"},
      {"theta,m\n0.1,0.3\n", "F_SC"},
      {"theta,m,F_SC,n\n0.1,0.3,3,1\n", "column 'n'"}};
  for (const auto& [text, place] : bad) {
    Cases(text);
    EXPECT_THAT(Refusal(), HasSubstr(place)) << text;
  }
}

}  // namespace
}  // namespace continuum::twin_pivot
