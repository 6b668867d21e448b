#include "identification/fit/bounded_least_squares.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// One residual y − 3. After the first evaluation it fails, or has no number or slope.
class Failing : public ceres::CostFunction {
 public:
  enum class How { kRefuses, kHasNoNumber, kHasNoSlope };
  explicit Failing(How how) : how_(how) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(1);
  }
  bool Evaluate(const double* const* y, double* r, double** J) const override {
    const bool fails = calls_++ > 0;
    if (fails && how_ == How::kRefuses) return false;
    r[0] = fails && how_ == How::kHasNoNumber ? kNaN : y[0][0] - 3;
    if (J && J[0]) J[0][0] = fails && how_ == How::kHasNoSlope ? kNaN : 1;
    return true;
  }

 private:
  How how_;
  mutable int calls_ = 0;
};

class BoundedLeastSquares : public Bench {};

// Ceres writes why to the log of its library, which prints on the terminal of whoever links it.
TEST_F(BoundedLeastSquares, PrintsNothingWhereCeresGivesUp) {
  const auto u = Command(0, 20);
  AddLog("a", "use: train", u, Pendulum().Run(u, testing::kPeriod));
  const auto model = ModelSpec::Load(Write("model.xml", Pendulum().Xml()));
  const Experiment experiment = ReadExperiment(
      "parameters:\n  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.05, "
      "lower: 0, upper: 1}\n");
  const Problem problem(experiment, model);
  for (const auto how :
       {Failing::How::kRefuses, Failing::How::kHasNoNumber, Failing::How::kHasNoSlope}) {
    Failing cost(how);
    Problem::Vector y = Scaled(problem, problem.Start());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    Minimize(cost, BoxOf(problem), {20, 1e-5}, y);
    const std::string err = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(err + ::testing::internal::GetCapturedStdout(), "");
    EXPECT_LT(y[0], 2.9);  // it was not found
  }
}

// Of all ways to hold unknowns at their bounds the best feasible one is the minimum.
double LeastByTrial(const Box& box, const Problem::Matrix& J, const Problem::Vector& r) {
  const Eigen::Index n = J.cols();
  double best = std::numeric_limits<double>::infinity();
  for (int held = 0; held < std::pow(3, n); ++held) {
    Problem::Vector s = Problem::Vector::Zero(n);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0, code = held; i < n; ++i, code /= 3) {
      if (code % 3 == 0) free.push_back(i);
      if (code % 3 > 0) s[i] = code % 3 == 1 ? box.lower[i] : box.upper[i];
    }
    if (!free.empty()) {
      const Problem::Matrix some = J(Eigen::all, free);
      s(free) = -some.colPivHouseholderQr().solve(r + J * s);
    }
    const bool inside =
        ((s - box.lower).array() >= -1e-12).all() && ((box.upper - s).array() >= -1e-12).all();
    if (inside) best = std::min(best, (r + J * s).squaredNorm());
  }
  return best;
}

TEST(SolveWithinBox, IsTheBestOfAllWaysToHoldUnknownsAtTheirBounds) {
  std::mt19937 rng(1);
  const auto some = [&](Eigen::Index rows, Eigen::Index columns) {
    return Problem::Matrix(Problem::Matrix::NullaryExpr(
        rows, columns, [&] { return std::uniform_real_distribution<double>(-1, 1)(rng); }));
  };
  for (int k = 0; k < 200; ++k) {
    const Eigen::Index n = 1 + k % 5;
    const Box box{-some(n, 1).cwiseAbs(), some(n, 1).cwiseAbs()};
    const Problem::Matrix J = some(8, n);
    const Problem::Vector r = some(8, 1);
    const Problem::Vector start = 0.5 * (box.lower + box.upper);
    const Problem::Vector z = SolveWithinBox(box, start, J, r + J * start);
    EXPECT_NEAR((r + J * z).squaredNorm(), LeastByTrial(box, J, r), 1e-9) << k;
    EXPECT_TRUE(((z - box.lower).array() >= 0).all() && ((box.upper - z).array() >= 0).all());
  }
}

}  // namespace
}  // namespace continuum
