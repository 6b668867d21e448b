#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "sim/numerics/linearize.h"
#include "sim/numerics/solver.h"

namespace continuum::numerics {

/// Limits of the unknowns of LevenbergMarquardt; none by default.
template <int N>
struct Bounds {
  using Vector = Eigen::Matrix<double, N, 1>;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector lower = Vector::Constant(N == Eigen::Dynamic ? 0 : N, -kInfinity);
  Vector upper = Vector::Constant(N == Eigen::Dynamic ? 0 : N, kInfinity);
};

/// Levenberg-Marquardt: minimises |f|^2 of M >= N residuals inside bounds, from x to x.
///
/// (J^T J + lambda diag(J^T J)) dx = -J^T f, with the gain ratio deciding lambda; an unknown at its
/// bound with the descent pointing outward is held. Done when |f| <= tolerance (a root), when no
/// free column of J makes an angle with f that matters (`gradient`) or when steps vanish (`step`).
/// For a root also ask `residual <= accept`: a minimum with a remainder is `kOk` here too.
template <class F, class Problem, int N>
Outcome LevenbergMarquardt(const Problem& problem, Eigen::Matrix<double, N, 1>& x,
                           Eigen::Index equations, const Options& options = {},
                           const Bounds<N>& bounds = {}) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Normal = Eigen::Matrix<double, N, N>;
  using Matrix = Eigen::Matrix<double, F::RowsAtCompileTime, N>;
  const Eigen::Index n = x.size();
  Outcome outcome;
  F f = F::Zero(equations), trial_f = f;
  Matrix jacobian(equations, n);
  if (bounds.lower.size() == n && n > 0) x = x.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  if (!Linearize(problem, x, f, jacobian)) {
    return internal::Failed(outcome, Status::kOutOfDomain, "the start is out of the domain");
  }
  const auto held = [&](Eigen::Index i, double slope) {
    if (bounds.lower.size() != n) return false;
    return (x[i] <= bounds.lower[i] && slope > 0) || (x[i] >= bounds.upper[i] && slope < 0);
  };
  outcome.residual = f.norm();
  double lambda = 1e-3;
  double growth = 2;
  while (outcome.residual > options.tolerance) {
    const Vector gradient = jacobian.transpose() * f;
    Normal normal = jacobian.transpose() * jacobian;
    Vector free_gradient = gradient;
    double cosine = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double scale = std::sqrt(normal(i, i)) * outcome.residual;
      if (held(i, gradient[i])) {
        free_gradient[i] = 0;
        normal.row(i).setZero();
        normal.col(i).setZero();
        normal(i, i) = 1;
      } else if (scale > 0) {
        cosine = std::max(cosine, std::abs(gradient[i]) / scale);
      }
    }
    if (cosine <= options.gradient) break;
    bool taken = false;
    while (!taken) {
      if (outcome.iterations++ == options.max_iterations) {
        return internal::Failed(outcome, Status::kNoConvergence, "too many iterations");
      }
      Normal damped = normal;
      for (Eigen::Index i = 0; i < n; ++i) {
        damped(i, i) += lambda * std::max(normal(i, i), 1e-300);
      }
      const Vector dx = -damped.ldlt().solve(free_gradient);
      Vector trial = x + dx;
      if (bounds.lower.size() == n && n > 0) {
        trial = trial.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
      }
      const Vector moved = trial - x;
      if (!(moved.norm() > options.step * (x.norm() + options.step))) {
        outcome.status = Status::kOk;
        return outcome;
      }
      const double norm = NormAt(problem, trial, trial_f);
      const double before = outcome.residual * outcome.residual;
      const double promised = -2 * gradient.dot(moved) - (jacobian * moved).squaredNorm();
      const double gain = (before - norm * norm) / std::max(promised, 1e-300);
      if (norm < outcome.residual && gain > 1e-4) {
        taken = true;
        x = trial;
        outcome.residual = norm;
        const double s = 2 * std::min(gain, 1.0) - 1;
        lambda = std::max(1e-15, lambda * std::max(1.0 / 3, 1 - s * s * s));
        growth = 2;
        if (std::max(before - norm * norm, promised) <= options.decrease * before) {
          outcome.status = Status::kOk;
          return outcome;
        }
        if (!Linearize(problem, x, f, jacobian)) {
          return internal::Failed(outcome, Status::kOutOfDomain, "a derivative is not finite");
        }
      } else {
        lambda *= growth;
        growth *= 2;
      }
    }
  }
  outcome.status = Status::kOk;
  return outcome;
}

}  // namespace continuum::numerics
