#include "identification/fit/secant_search.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Residuals by a function, slopes by its differences over a distance; each counts what it costs.
class Counted : public ceres::CostFunction {
 public:
  using Residuals = std::function<Vector(const Vector&)>;
  Counted(Residuals f, Eigen::Index residuals, int parameters, double distance = 1e-6)
      : f_(std::move(f)), distance_(distance) {
    set_num_residuals(static_cast<int>(residuals));
    mutable_parameter_block_sizes()->push_back(parameters);
  }
  bool Evaluate(const double* const* y, double* residuals, double** jacobians) const override {
    const Vector x = Vector::Map(y[0], parameter_block_sizes()[0]), r = Value(x);
    Vector::Map(residuals, r.size()) = r;
    if (!jacobians || !jacobians[0]) return r.allFinite();
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      Vector beside = x;
      beside[i] += distance_;
      const Vector slope = (Value(beside) - r) / distance_;
      for (Eigen::Index k = 0; k < r.size(); ++k) jacobians[0][k * x.size() + i] = slope[k];
    }
    return r.allFinite();
  }
  int count() const { return count_; }

 private:
  Vector Value(const Vector& x) const { return ++count_, f_(x); }

  Residuals f_;
  double distance_;
  mutable int count_ = 0;
};

// A swing that dies away: amplitude, rate, frequency; plus a ripple as of joints that stick.
Vector Swing(const Vector& x, double ripple = 0) {
  Vector r(60);
  for (Eigen::Index k = 0; k < r.size(); ++k) {
    const double t = 0.1 * static_cast<double>(k);
    r[k] = x[0] * std::exp(-x[1] * t) * std::sin(x[2] * t) +
           ripple * std::sin(3e3 * x.sum() + static_cast<double>(k));
  }
  return r;
}

Counted SwingCost(double ripple = 0, double distance = 1e-6) {
  const Vector truth = Swing(Vector{{1, 0.3, 2}});
  return Counted([=](const Vector& x) -> Vector { return Swing(x, ripple) - truth; }, 60, 3,
                 distance);
}

Box Everywhere(Eigen::Index n) {
  return {Vector::Constant(n, -kInfinity), Vector::Constant(n, kInfinity)};
}

const Search kSearch{40, 1e-6};

TEST(SecantSearch, FindsTheMinimumForFarFewerValuesThanSlopesAtEveryStep) {
  const Counted cost = SwingCost();
  Counted same = SwingCost();
  Vector y{{0.7, 0.5, 1.8}}, by_slopes = y;
  Matrix slopes;
  const auto summary = MinimizeBySecants(cost, Everywhere(3), {40, 1e-10}, y, slopes);
  Minimize(same, Everywhere(3), {40, 1e-10}, by_slopes);
  EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE);
  EXPECT_LT((y - Vector{{1, 0.3, 2}}).norm(), 1e-4);
  EXPECT_LT((by_slopes - Vector{{1, 0.3, 2}}).norm(), 1e-4);
  EXPECT_LT(cost.count(), 0.7 * same.count());
}

// Slopes at a point are those of the ripple: some six times as steep as the valley. Those over 0.02
// are off by a fifth.
TEST(SecantSearch, SeesTheValleyThroughARipple) {
  const Counted cost = SwingCost(2e-3, 0.02);
  Vector y{{0.7, 0.5, 1.8}};
  Matrix slopes;
  MinimizeBySecants(cost, Everywhere(3), kSearch, y, slopes);
  EXPECT_LT((y - Vector{{1, 0.3, 2}}).norm(), 0.03);
}

TEST(SecantSearch, StaysWithinTheBoxAndIsBestThere) {
  const Counted cost = SwingCost();
  Vector y{{0.7, 0.5, 1.8}};
  Box box = Everywhere(3);
  box.upper[0] = 0.8;
  Matrix slopes;
  MinimizeBySecants(cost, box, kSearch, y, slopes);
  EXPECT_EQ(y[0], 0.8);
  Counted held(
      [](const Vector& x) -> Vector {
        return Swing(Vector{{0.8, x[0], x[1]}}) - Swing(Vector{{1, 0.3, 2}});
      },
      60, 2);
  Vector best{{0.5, 1.8}};
  Minimize(held, Everywhere(2), {40, 1e-12}, best);
  EXPECT_NEAR(y[1], best[0], 2e-3);
  EXPECT_NEAR(y[2], best[1], 2e-3);
}

TEST(SecantSearch, TurnsBackWhereNothingCanBeSimulated) {
  const Counted cost(
      [](const Vector& x) -> Vector {
        const double r = x[0] > 2.1 ? kInfinity : std::exp(x[0]) - std::exp(2.0);
        return Vector{{r, 0}};
      },
      2, 1);
  Vector y{{0}};  // a whole step goes to 6.4
  Matrix slopes;
  const auto summary = MinimizeBySecants(cost, Everywhere(1), kSearch, y, slopes);
  EXPECT_EQ(summary.termination_type, ceres::CONVERGENCE);
  EXPECT_NEAR(y[0], 2, 1e-4);
}

TEST(SecantSearch, BeginsWithSlopesThatAreKnownAndGivesThoseAtItsEnd) {
  const Counted cost = SwingCost();
  Vector y{{0.9, 0.33, 1.98}}, again = y;
  Matrix slopes;
  MinimizeBySecants(cost, Everywhere(3), {3, 1e-10}, y, slopes);
  ASSERT_EQ(slopes.cols(), 3);
  const Counted known = SwingCost();
  MinimizeBySecants(known, Everywhere(3), {1, 1e-10}, again, slopes);
  EXPECT_EQ(known.count(), 2);  // at the start and after one step
}

TEST(SecantSearch, SaysWhenItCannotBegin) {
  const Counted cost([](const Vector&) -> Vector { return Vector::Constant(2, kInfinity); }, 2, 1);
  Vector y{{0}};
  Matrix slopes;
  EXPECT_EQ(MinimizeBySecants(cost, Everywhere(1), kSearch, y, slopes).termination_type,
            ceres::FAILURE);
}

class Stopper : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    return s.iteration == 2 ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
};

TEST(SecantSearch, EndsWhenWhoeverWatchesSaysSo) {
  const Counted cost = SwingCost();
  Vector y{{0.7, 0.5, 1.8}};
  Matrix slopes;
  Stopper stopper;
  const auto summary = MinimizeBySecants(cost, Everywhere(3), {40, 1e-10, &stopper}, y, slopes);
  EXPECT_EQ(summary.termination_type, ceres::USER_SUCCESS);
  EXPECT_EQ(summary.iterations.size(), 3u);
}

}  // namespace
}  // namespace continuum
