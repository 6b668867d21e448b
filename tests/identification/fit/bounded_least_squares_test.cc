#include "identification/fit/bounded_least_squares.h"

#include <limits>
#include <string>

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

}  // namespace
}  // namespace continuum
