// ctest labels: slow
#include "identification/diagnosis/screening.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/long_test.h"

namespace continuum {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

class Screened : public ::testing::Test {
 protected:
  static constexpr Eigen::Index kRows = 200;

  Vector Normal() {
    Vector v(kRows);
    for (double& x : v) x = normal_(rng_);
    return v;
  }
  Probe OneWay(const Vector& column, double sign = 0) const { return {column, {sign}}; }

  std::mt19937_64 rng_{7};
  std::normal_distribution<double> normal_;
};

TEST_F(Screened, ExplainsThePartAlongItsColumn) {
  const Vector c = Normal();
  const Vector z = Normal() - 3 * c;
  const Explained e = ExplainedBy(OneWay(c), z);
  EXPECT_NEAR(e.coefficients[0], -c.dot(z) / c.squaredNorm(), 1e-12);
  EXPECT_NEAR(e.amount, std::pow(c.dot(z), 2) / c.squaredNorm(), 1e-9);
}

// r = r₀ + J d: back by −d, but for what is fixed.
TEST_F(Screened, TheShiftIsWhereTheResidualIsLeast) {
  Matrix J(kRows, 3);
  J << Normal(), Normal(), Normal();
  const Vector d{{0.3, -2, 0.7}}, noise = 1e-6 * Normal();
  const Vector r = noise + J * d;
  const std::vector<bool> use{true};
  const std::vector<Matrix> none{Matrix(kRows, 0)};  // of the time step
  const ProjectedResidual all(Whitening(), use, {r}, {J}, {false, false, false}, none);
  EXPECT_LT((all.shift() + d).norm(), 1e-6);
  const ProjectedResidual some(Whitening(), use, {r}, {J}, {false, true, false}, none);
  EXPECT_EQ(some.shift()[1], 0);
  EXPECT_NEAR((r + J * some.shift()).squaredNorm(), some.cost(), 1e-9 * some.cost());
}

TEST_F(Screened, AForbiddenSignExplainsNothing) {
  const Vector c = Normal();
  const Vector z = 3 * c;  // wants −3
  EXPECT_EQ(ExplainedBy(OneWay(c, 1), z).amount, 0);
  EXPECT_GT(ExplainedBy(OneWay(c, -1), z).amount, 0);
}

// 400 draws of noise: the share below 5 % is within three standard errors (1.1 %).
TEST_F(Screened, TheBestOfManyIsSignificantInFivePercentOfPureNoise) {
  CONTINUUM_LONG_IF_SANITIZED("400 screenings");
  std::vector<std::vector<Probe>> candidates;
  const Vector common = Normal();
  for (int i = 0; i < 12; ++i) {
    const Vector column = Normal() + 2 * common;  // they resemble each other
    candidates.push_back({OneWay(column, i % 3 - 1)});
  }
  int alarms = 0;
  for (int draw = 0; draw < 400; ++draw) {
    const auto s = SignificanceOf(candidates, Normal(), 5);
    alarms += *std::min_element(s.p.begin(), s.p.end()) < 0.05;
  }
  EXPECT_NEAR(alarms / 400.0, 0.05, 0.033);
}

// One of so many candidates is likely to be beyond all of so few draws: no alarm by itself.
TEST_F(Screened, ManyCandidatesRaiseNoMoreAlarmsWithFewDraws) {
  CONTINUUM_LONG_IF_SANITIZED("400 screenings");
  std::vector<std::vector<Probe>> candidates;
  for (int i = 0; i < 60; ++i) candidates.push_back({OneWay(Normal(), i % 3 - 1)});
  int alarms = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    Matrix draws(kRows, 99);
    for (auto column : draws.colwise()) column = Normal();
    const auto s = SignificanceOf(candidates, Normal(), 5, draws);
    alarms += *std::min_element(s.p.begin(), s.p.end()) < 0.05;
  }
  EXPECT_NEAR(alarms / 400.0, 0.05, 0.033);
}

TEST_F(Screened, AStrongEffectIsSignificantAndTheBest) {
  std::vector<std::vector<Probe>> candidates;
  std::vector<Vector> columns;
  for (int i = 0; i < 5; ++i) {
    columns.push_back(Normal());
    candidates.push_back({OneWay(columns.back())});
  }
  const auto s = SignificanceOf(candidates, Normal() + columns[3], 5);
  EXPECT_LT(s.p[3], 0.001);
  for (int i = 0; i < 5; ++i) EXPECT_LE(s.explained[i], s.explained[3]);
}

// Whatever the others explain of it, and however much more.
TEST_F(Screened, AStrongEffectIsSignificantInEveryCandidateThatExplainsSomeOfIt) {
  const Vector effect = Normal();
  std::vector<std::vector<Probe>> candidates;
  for (const double other : {0.0, 0.3, 1.0, 3.0})
    candidates.push_back({OneWay(effect + other * Normal())});
  for (const double size : {1.0, 10.0, 1000.0}) {
    for (const double p : SignificanceOf(candidates, Normal() + size * effect, 5).p)
      EXPECT_LT(p, 0.001) << size;
  }
}

TEST_F(Screened, RepeatsExactlyForASeed) {
  const std::vector<std::vector<Probe>> candidates{{OneWay(Normal())}, {OneWay(Normal(), 1)}};
  const Vector z = Normal();
  EXPECT_EQ(SignificanceOf(candidates, z, 3).p, SignificanceOf(candidates, z, 3).p);
}

}  // namespace
}  // namespace continuum
