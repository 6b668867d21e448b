#include "identification/fit/evolution.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

template <class Function>
auto Each(Function cost) {
  return [cost](const std::vector<Vector>& points) {
    std::vector<double> all;
    for (const Vector& y : points) all.push_back(cost(y));
    return all;
  };
}

// Long and bent: the minimum at (1, …, 1) lies at the end of a narrow valley (Rosenbrock 1960).
double Valley(const Vector& y) {
  double sum = 0;
  for (Eigen::Index i = 0; i + 1 < y.size(); ++i)
    sum += 100 * std::pow(y[i + 1] - y[i] * y[i], 2) + std::pow(1 - y[i], 2);
  return sum;
}

// A bowl that is a thousand times as steep in one direction, with ripples on it. There are minima
// at every whole number; the least is at 0.
double Ripples(const Vector& y) {
  double sum = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double steep = i == 0 ? 1000 : 1;
    sum += steep * (y[i] * y[i] + 0.5 * (1 - std::cos(2 * std::numbers::pi * y[i])));
  }
  return sum;
}

TEST(Evolution, FollowsABentValleyToItsEnd) {
  const Vector first = Vector::Constant(4, -0.5);
  const Evolved best = Evolve(Each(Valley), first, 0.3 * Matrix::Identity(4, 4),
                              {.generations = 400, .flat = 1e-12});
  EXPECT_LT((best.y - Vector::Ones(4)).norm(), 1e-3);
  EXPECT_NEAR(best.cost, Valley(best.y), 0);
}

TEST(Evolution, CrossesRipplesThatSlopesStopIn) {
  const Vector first = Vector::Constant(3, 4);
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Evolved best = Evolve(Each(Ripples), first, 2 * Matrix::Identity(3, 3),
                                {.generations = 300, .flat = 1e-12, .seed = seed});
    if (best.cost < 1e-3) ++found;
  }
  EXPECT_GE(found, 8);
}

TEST(Evolution, RepeatsWithTheSameSeed) {
  const Vector first = Vector::Constant(3, 1);
  const auto run = [&](std::uint64_t seed) {
    return Evolve(Each(Ripples), first, Matrix::Identity(3, 3), {.generations = 5, .seed = seed});
  };
  EXPECT_EQ(run(1).y, run(1).y);
  EXPECT_NE(run(1).y, run(2).y);
}

TEST(Evolution, KeepsToWhereThereIsACost) {
  const auto half = [](const Vector& y) {
    return y[0] > 0 ? (y - Vector::Constant(2, 0.1)).squaredNorm()
                    : std::numeric_limits<double>::infinity();
  };
  const Evolved best = Evolve(Each(half), Vector::Ones(2), Matrix::Identity(2, 2), {});
  EXPECT_LT(best.cost, 1e-2);
  EXPECT_GT(best.y[0], 0);
}

TEST(Evolution, EndsWhereNothingChangesTheCost) {
  const auto flat = [](const Vector&) { return 2.0; };
  const Evolved best = Evolve(Each(flat), Vector::Ones(2), Matrix::Identity(2, 2), {});
  EXPECT_LT(best.evaluations, 10u);
  EXPECT_EQ(best.cost, 2);
}

// Around the lowest point each other one is higher.
TEST(Evolution, EndsEarlyWhereItFindsNothingLower) {
  const auto high = [](const Vector& y) { return 2 + Ripples(y); };
  const EvolutionOptions options{.in_vain = 3, .lower = 1, .flat = 1e-12};
  const Matrix spread = Matrix::Identity(2, 2);
  const std::size_t in_vain = Evolve(Each(high), Vector::Zero(2), spread, options).evaluations;
  const std::size_t found = Evolve(Each(Valley), Vector::Ones(2), spread, options).evaluations;
  EXPECT_EQ(in_vain % 3, 0u);
  EXPECT_GT(found, in_vain);
}

}  // namespace
}  // namespace continuum
