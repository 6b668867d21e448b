#include "identification/fit/ripples.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "identification/fit/bounded_least_squares.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

Matrix SpreadOf(const Fit& fit, const Matrix& J) {
  const Eigen::Index n = J.cols();
  const Matrix precision =
      static_cast<double>(n) / (2 * fit.cost) * J.transpose() * J + Matrix::Identity(n, n);
  const Eigen::LLT<Matrix> factor(precision);
  return factor.matrixU().solve(Matrix(Matrix::Identity(n, n)));
}

bool HasRipples(const Problem& problem, const Fit& fit, const Matrix& J,
                const std::vector<bool>& use, const FitOptions& options) {
  constexpr double kStep = 0.1, kWrong = 1.0 / 3;
  const Vector y = Scaled(problem, fit.x);
  const Vector here = LossResiduals(problem, fit.x, use, options);
  const Matrix steps = kStep * std::sqrt(static_cast<double>(y.size())) * SpreadOf(fit, J);
  std::vector<double> wrong(static_cast<std::size_t>(y.size()));
  const auto look = [&](std::size_t i) {
    const Vector beside = y + steps.col(static_cast<Eigen::Index>(i));
    const Vector x = problem.Clamp(Unscaled(problem, beside.data()));
    const Vector move = J * (Scaled(problem, x) - y);
    const Vector lack = LossResiduals(problem, x, use, options) - here - move;
    wrong[i] = lack.allFinite() && move.norm() > 0 ? lack.norm() / move.norm() : 0;
  };
  ShareTasks(wrong.size(), look, [&](auto& archive, std::size_t i) { archive(wrong[i]); });
  return *std::max_element(wrong.begin(), wrong.end()) > kWrong;
}

}  // namespace continuum
