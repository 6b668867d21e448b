#include "identification/fit/bounded_least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glog/logging.h>

namespace continuum {
namespace {

// Why a solve is given up stands in its summary. Ceres also writes it to glog, which prints it on
// the terminal of whoever links this.
void SilenceCeres() { FLAGS_minloglevel = google::GLOG_FATAL; }

}  // namespace

Problem::Vector Scaled(const Problem& problem, const Problem::Vector& x) {
  Problem::Vector y = problem.Clamp(x);
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] /= problem.parameters()[i].scale;
  return y;
}

Problem::Vector Unscaled(const Problem& problem, const double* y) {
  const auto& parameters = problem.parameters();
  Problem::Vector x(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = y[i] * parameters[i].scale;
  return problem.Clamp(x);
}

std::pair<double, double> SoftL1(double r, double soft) {
  if (soft == 0) return {r, 1};
  const double root = std::sqrt(1 + r * r / (soft * soft));
  const double w = std::copysign(soft * std::sqrt(2 * (root - 1)), r);
  return {w, std::abs(w) > 1e-12 * soft ? r / (w * root) : 1};
}

Box BoundsOf(const Problem& problem) {
  const auto n = static_cast<Eigen::Index>(problem.parameters().size());
  Box box{Problem::Vector(n), Problem::Vector(n)};
  for (Eigen::Index i = 0; i < n; ++i)
    box.lower[i] = problem.parameters()[i].lower, box.upper[i] = problem.parameters()[i].upper;
  return box;
}

Box BoxOf(const Problem& problem) {
  Box box = BoundsOf(problem);
  for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
    const double scale = problem.parameters()[i].scale;
    box.lower[i] /= scale, box.upper[i] /= scale;
  }
  return box;
}

Problem::Vector BoundedStep(const Box& box, const Problem::Vector& y, const Problem::Matrix& A,
                            const Problem::Vector& g) {
  Problem::Matrix left = A;
  Problem::Vector right = -g;
  std::vector<bool> held(static_cast<std::size_t>(y.size()), false);
  for (;;) {
    const Problem::Vector step = left.ldlt().solve(right);
    bool again = false;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const bool stopped =
          (y[i] <= box.lower[i] && step[i] < 0) || (y[i] >= box.upper[i] && step[i] > 0);
      if (held[i] || !stopped) continue;
      held[i] = again = true;
      left.row(i).setZero(), left.col(i).setZero();
      left(i, i) = 1, right[i] = 0;
    }
    if (!again) return step;
  }
}

// From bound to bound, each step as far as the first that it meets, which holds it from then on
// where it pulls outward.
Problem::Vector SolveWithinBox(const Box& box, const Problem::Vector& y, const Problem::Matrix& J,
                               const Problem::Vector& r) {
  constexpr double kFirm = 1e-10;  // of the curvature: directions that nothing determines stay
  Problem::Matrix A = J.transpose() * J;
  for (double& entry : A.diagonal()) entry += kFirm * entry + std::numeric_limits<double>::min();
  Problem::Vector at = y;
  for (Eigen::Index k = 0; k <= 4 * y.size(); ++k) {
    const Problem::Vector step = BoundedStep(box, at, A, J.transpose() * (r + J * (at - y)));
    double reach = 1;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double room = step[i] > 0 ? box.upper[i] - at[i] : at[i] - box.lower[i];
      if (std::abs(step[i]) > room)
        reach = std::min(reach, std::max(0.0, room / std::abs(step[i])));
    }
    at = (at + reach * step).cwiseMax(box.lower).cwiseMin(box.upper);
    for (Eigen::Index i = 0; i < y.size(); ++i) {  // rounding must not keep it off its bound
      const double near = 1e-12 * std::abs(step[i]);
      if (at[i] - box.lower[i] <= near) at[i] = box.lower[i];
      if (box.upper[i] - at[i] <= near) at[i] = box.upper[i];
    }
    if (reach == 1) break;
  }
  return at;
}

ceres::Solver::Summary Minimize(ceres::CostFunction& cost, const Box& box, const Search& search,
                                Problem::Vector& y) {
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem ceres(ownership);
  ceres.AddResidualBlock(&cost, nullptr, y.data());
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    if (std::isfinite(box.lower[i]))
      ceres.SetParameterLowerBound(y.data(), static_cast<int>(i), box.lower[i]);
    if (std::isfinite(box.upper[i]))
      ceres.SetParameterUpperBound(y.data(), static_cast<int>(i), box.upper[i]);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = search.iterations;
  solver.function_tolerance = search.tolerance;
  solver.parameter_tolerance = 1e-7;
  solver.initial_trust_region_radius = 1e3;
  solver.max_num_consecutive_invalid_steps = 12;
  // Steps that a bound cuts short are searched by values alone: a gradient is a Jacobian here.
  solver.line_search_interpolation_type = ceres::BISECTION;
  solver.max_num_line_search_step_size_iterations = 3;
  solver.logging_type = ceres::SILENT;
  SilenceCeres();
  if (search.watch) solver.callbacks.push_back(search.watch);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres, &summary);
  return summary;
}

}  // namespace continuum
