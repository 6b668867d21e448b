#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "identification/statistics/uncertainty.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Straight-line regression on two swinging columns, beside a problem that lends its parameters.
class UncertaintyTest : public testing::Bench {
 protected:
  static constexpr Eigen::Index kRows = 400;

  UncertaintyTest() : J_(kRows, 2) {
    for (Eigen::Index k = 0; k < kRows; ++k)
      J_.row(k) << 1 + 0.5 * std::sin(0.02 * static_cast<double>(k)),
          std::sin(0.1 * static_cast<double>(k));
  }
  void SetUp() override {
    Bench::SetUp();
    AddLog("log", "use: train", testing::Command(0, 10), std::vector<double>(10));
    const ModelSpec system = ModelSpec::Load(Write("model.xml", testing::Pendulum{}.Xml("", 1e-3)));
    problem_.emplace(ReadExperiment(Bounds(-9)), system);
    bounded_.emplace(ReadExperiment(Bounds(0)), system);
  }
  static std::string Bounds(double least_damping) {
    return fmt::format(
        "parameters:\n"
        "  - {{name: b, target: 'joint:hinge', attribute: damping, lower: {}, upper: 9}}\n"
        "  - {{name: k, target: 'joint:hinge', attribute: stiffness, lower: -9, upper: 9}}\n",
        least_damping);
  }
  // Noise of size 1 that keeps so much of itself from row to row.
  Vector Noise(double rho) {
    std::normal_distribution<double> normal;
    Vector e(kRows);
    for (Eigen::Index k = 0; k < kRows; ++k)
      e[k] = k == 0 ? normal(random_) : rho * e[k - 1] + std::sqrt(1 - rho * rho) * normal(random_);
    return e;
  }
  Uncertainty Of(const Vector& x, const std::vector<Scores>& motion) const {
    return UncertaintyFrom(*problem_, x, {motion});
  }
  // How many of 600 intervals hold 0; estimate: the value and its blocks for a draw of noise.
  template <class Estimate>
  double Covered(double rho, const Estimate& estimate) {
    int held = 0;
    for (int draw = 0; draw < 300; ++draw) {
      const auto [x, motion] = estimate(Noise(rho));
      const Uncertainty u = Of(x, motion);
      for (Eigen::Index i = 0; i < 2; ++i) held += u.lower[i] <= 0 && 0 <= u.upper[i];
    }
    return held / 600.0;
  }

  Matrix J_;
  std::optional<Problem> problem_, bounded_;  // the first parameter from 0 on
  std::mt19937 random_{5};
};

TEST_F(UncertaintyTest, NinetyFiveOfHundredIntervalsHoldUnderNoiseThatLasts) {
  const auto plain = [&](const Vector& e) {
    const Vector x = (J_.transpose() * J_).ldlt().solve(J_.transpose() * e);
    return std::pair{x, std::vector<Scores>{{e - J_ * x, J_, Vector::Ones(kRows)}}};
  };
  for (const double rho : {0.0, 0.5, 0.9}) {
    EXPECT_GE(Covered(rho, plain), 0.93) << rho;
    EXPECT_LE(Covered(rho, plain), 0.97) << rho;
  }
}

// What a model gets wrong in two channels at once is one error, not two.
TEST_F(UncertaintyTest, NineOfTenIntervalsHoldWhereChannelsErrTogether) {
  const auto twice = [&](const Vector& e) {
    const Vector x = (J_.transpose() * J_).ldlt().solve(J_.transpose() * e);
    const Scores one{e - J_ * x, J_, Vector::Ones(kRows)};
    return std::pair{x, std::vector<Scores>{one, one}};
  };
  EXPECT_GE(Covered(0.5, twice), 0.9);
  EXPECT_LE(Covered(0.5, twice), 0.97);
}

// Recorded twice without noise, a log says no more of the parameters than once.
TEST_F(UncertaintyTest, WhatReplicatesHaveInCommonCountsOnce) {
  std::vector<double> measured(kRows);
  for (std::size_t k = 0; k < kRows; ++k)
    measured[k] = 0.3 * std::sin(0.02 * static_cast<double>(k));
  for (const char* name : {"first", "second"})
    AddLog(name, "trial: swing, use: train", testing::Command(0, kRows), measured);
  const Experiment e = ReadExperiment(Bounds(-9));
  const Problem problem(e, ModelSpec::Load(folder_ / "model.xml"));
  const Vector x{{0.1, 0.5}};
  const auto error = [&](const std::vector<bool>& use) {
    const auto r = problem.Residuals(x, use);
    return UncertaintyOf(problem, x, r, problem.Jacobian(x, r, use)).standard_error;
  };
  EXPECT_TRUE(error({false, true, true}).isApprox(error({false, true, false}), 0.02));
}

// What the time step adds is known: errors follow from the noise alone, and intervals still reach
// over the value at a step of zero.
TEST_F(UncertaintyTest, WhatTheStepAddsIsNoNoise) {
  Matrix added = Matrix::Zero(kRows, 3);
  for (Eigen::Index k = 0; k < kRows; ++k)
    added(k, 0) = 3 * std::sin(0.003 * static_cast<double>(k));
  const Vector e = Noise(0);
  const auto of = [&](const Vector& r) {
    const Vector x = -(J_.transpose() * J_).ldlt().solve(J_.transpose() * r);
    return std::pair{x, std::vector<Vector>{r + J_ * x}};
  };
  const auto [x, r] = of(e + kWholeStep * added.col(0));
  const auto [pure, noise] = of(e);
  Uncertainty u = UncertaintyOf(*problem_, x, r, {J_});
  const double before = u.standard_error[0];
  AllowForStep(*problem_, {J_}, {added}, {}, u);
  LeaveOutStep(*problem_, x, r, {J_}, {added}, {}, 0, u);
  const Uncertainty want = UncertaintyOf(*problem_, pure, noise, {J_});
  EXPECT_TRUE(u.standard_error.isApprox(want.standard_error, 1e-9));
  EXPECT_GT(before, 3 * want.standard_error[0]);
  const double margin = 1.9 * want.standard_error[0];
  EXPECT_LE(u.lower[0], std::min(pure[0], x[0]) - margin);
  EXPECT_GE(u.upper[0], std::max(pure[0], x[0]) + margin);
}

// Columns that look alike: what holds one at its bound moves the other.
TEST_F(UncertaintyTest, IntervalsHoldTooWhereAValueNextToItsBoundIsNotSeen) {
  J_.col(1) += 2 * J_.col(0);
  const Matrix H = J_.transpose() * J_;
  const double error = std::sqrt(H.inverse()(0, 0));
  for (const double inside : {0.0, 0.5, 1.0, 2.0}) {
    const Vector truth{{inside * error, 0.0}};
    int at_bound = 0;
    Vector held = Vector::Zero(2);
    for (int draw = 0; draw < 300; ++draw) {
      const Vector y = J_ * truth + Noise(0);
      Vector x = H.ldlt().solve(J_.transpose() * y);
      if (x[0] < 0) x << 0, J_.col(1).dot(y) / H(1, 1);
      const Uncertainty u =
          UncertaintyFrom(*bounded_, x, {{{y - J_ * x, J_, Vector::Ones(kRows)}}});
      at_bound += u.at_bound[0];
      EXPECT_TRUE(!u.at_bound[0] || (u.lower[0] == 0 && u.upper[0] > error)) << u.upper[0];
      for (Eigen::Index i = 0; i < 2; ++i)
        held[i] += u.lower[i] <= truth[i] && truth[i] <= u.upper[i];
    }
    EXPECT_TRUE(inside > 1 || at_bound > 30) << at_bound;
    EXPECT_GE(held.minCoeff(), 0.93 * 300) << inside << ": " << held.transpose();
  }
}

TEST_F(UncertaintyTest, RowsThatWereNotMeasuredAreSkipped) {
  const Vector e = Noise(0.9);
  Scores empty{e, J_, Vector::Ones(kRows)}, gone{Vector(200), Matrix(200, 2), Vector::Ones(200)};
  for (Eigen::Index k = 0; k < kRows; k += 2) {
    gone.r[k / 2] = e[k], gone.J.row(k / 2) = J_.row(k);
    empty.r[k + 1] = 0, empty.J.row(k + 1).setZero();
  }
  const Vector x = Vector::Zero(2);
  EXPECT_TRUE(Of(x, {empty}).standard_error.isApprox(Of(x, {gone}).standard_error, 1e-12));
}

TEST_F(UncertaintyTest, AsManyRowsAsParametersTellNothing) {
  const Uncertainty u = Of(Vector::Zero(2), {{Vector::Zero(2), J_.topRows(2), Vector::Ones(2)}});
  EXPECT_EQ(u.lower, Vector::Constant(2, -9));
  EXPECT_EQ(u.upper, Vector::Constant(2, 9));
  EXPECT_NEAR(u.standard_error[0], 18 / std::sqrt(12), 1e-12);
}

}  // namespace
}  // namespace continuum
