#pragma once

#include <ceres/jet.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "sim/io/interrupt.h"

/// Roots and least squares of small dense systems, shared by the static models.
///
/// A *problem* is any object with
///
///   template <class T> bool operator()(const T* x, T* f) const;
///
/// which writes the residuals f(x) and returns false when x is out of its domain (a fold, a cable
/// that would have to push): the solvers then step back. T is `double` or a `ceres::Jet`; write
/// `using std::sqrt;` before calling mathematical functions, so that both are found. A problem
/// whose derivatives are known by hand offers instead, beside operator() for double,
///
///   bool Jacobian(const Vector& x, Vector& f, Matrix& jacobian) const;
///
/// with the caller's own Eigen types. Otherwise the Jacobian comes from dual numbers: exact, in one
/// pass for a fixed number of unknowns and in blocks of eight for a dynamic one.
///
/// Scale the residuals so that their norm means something (the models divide by EI/L): tolerances
/// are absolute norms. Fixed sizes never touch the heap while iterating.
namespace continuum::statics {

enum class Status { kOk, kNoConvergence, kOutOfDomain };

/// How a solve ended. `why` is empty when ok, otherwise one sentence for the user.
struct Outcome {
  Status status = Status::kNoConvergence;
  int iterations = 0;  ///< linear systems solved, over all stages
  double residual = std::numeric_limits<double>::infinity();  ///< |f| at the last point
  double micros = 0;                                          ///< wall time [us]; set by Timed
  std::string why = {};

  bool ok() const { return status == Status::kOk; }
};

struct Options {
  double tolerance = 1e-12;  ///< |f| at which iteration ends
  double accept = 1e-9;      ///< |f| that is enough when rounding allows no further decrease
  int max_iterations = 60;
  double max_step = std::numeric_limits<double>::infinity();  ///< longest step |dx| (Newton)
  bool damped = true;  ///< false: full steps only, and each must halve |f| (corrector of a path)
  double gradient = 1e-12;  ///< least squares: largest cosine between f and a column of J when done
  double decrease = 0;  ///< least squares: relative change of |f|^2, made and promised, when done
  double step = 1e-13;  ///< least squares: |dx| relative to |x| when done
};

/// Wall time of `solve` [us], written into its outcome.
template <class Solve>
Outcome Timed(Solve&& solve) {
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome = solve();
  const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begin;
  outcome.micros = spent.count();
  return outcome;
}

/// f and J = df/dx by dual numbers or by the problem's own Jacobian; false when x is out of the
/// domain or a number is not finite. f and jacobian must have their sizes. Throws Error when the
/// user has asked to stop: no solver goes on without it.
template <class Problem, class X, class F, class J>
bool Linearize(const Problem& problem, const X& x, F& f, J& jacobian) {
  StopIfRequested();
  if constexpr (requires { problem.Jacobian(x, f, jacobian); }) {
    return problem.Jacobian(x, f, jacobian) && f.allFinite() && jacobian.allFinite();
  } else {
    constexpr bool kFixed = X::RowsAtCompileTime != Eigen::Dynamic;
    // An even number of derivatives fills vector registers: of three, one more costs less than
    // none.
    constexpr int kBlock = kFixed ? X::RowsAtCompileTime + X::RowsAtCompileTime % 2 : 8;
    using Dual = ceres::Jet<double, kBlock>;
    Eigen::Matrix<Dual, X::RowsAtCompileTime, 1> dual_x(x.size());
    Eigen::Matrix<Dual, F::RowsAtCompileTime, 1> dual_f(f.size());
    for (Eigen::Index first = 0; first < x.size(); first += kBlock) {
      const Eigen::Index count = std::min<Eigen::Index>(kBlock, x.size() - first);
      for (Eigen::Index i = 0; i < x.size(); ++i) dual_x[i] = Dual(x[i]);
      for (Eigen::Index i = 0; i < count; ++i) dual_x[first + i].v[i] = 1;
      if (!problem(dual_x.data(), dual_f.data())) return false;
      for (Eigen::Index row = 0; row < f.size(); ++row) {
        jacobian.row(row).segment(first, count) = dual_f[row].v.head(count).transpose();
      }
    }
    for (Eigen::Index row = 0; row < f.size(); ++row) f[row] = dual_f[row].a;
    return f.allFinite() && jacobian.allFinite();
  }
}

/// J by central differences with steps `delta` max(1, |x_i|): for residuals that contain a solve.
template <class Problem, class X, class F, class J>
bool Differences(const Problem& problem, const X& x, double delta, F& f, J& jacobian) {
  if (!problem(x.data(), f.data())) return false;
  X at = x;
  F above = f, below = f;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double h = delta * std::max(1.0, std::abs(x[i]));
    at[i] = x[i] + h;
    if (!problem(at.data(), above.data())) return false;
    at[i] = x[i] - h;
    if (!problem(at.data(), below.data())) return false;
    at[i] = x[i];
    jacobian.col(i) = (above - below) / (2 * h);
  }
  return f.allFinite() && jacobian.allFinite();
}

/// |f(x)|, infinite out of the domain.
template <class Problem, class X, class F>
double NormAt(const Problem& problem, const X& x, F& f) {
  if (!problem(x.data(), f.data()) || !f.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  return f.norm();
}

namespace internal {

inline Outcome Failed(Outcome outcome, Status status, std::string why) {
  outcome.status = status;
  outcome.why = std::move(why);
  return outcome;
}

}  // namespace internal

/// Damped Newton for as many equations as unknowns, from x to x: J dx = -f, |dx| <= max_step, then
/// halved until |f| falls by the Armijo rule (1e-4) and the point is in the domain. A factored J is
/// used again for as long as a step with it leaves less than a twentieth of |f|. One step is taken
/// even from within the tolerance, so that answers to small loads keep their digits.
///
/// With `damped` false it takes full steps and gives up as soon as one does not halve |f|: it then
/// stays on the branch it was started on. x is left at the best point, also on failure.
template <class Problem, int N>
Outcome Newton(const Problem& problem, Eigen::Matrix<double, N, 1>& x,
               const Options& options = {}) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Outcome outcome;
  Vector f = Vector::Zero(x.size()), trial_f = f, trial = f, dx = f;
  Matrix jacobian(x.size(), x.size());
  if (!Linearize(problem, x, f, jacobian)) {
    return internal::Failed(outcome, Status::kOutOfDomain, "the start is out of the domain");
  }
  Eigen::PartialPivLU<Matrix> factors(x.size());
  bool factored = false;
  bool linearized = true;
  outcome.residual = f.norm();
  const auto unfinished = [&] {
    return outcome.residual > options.tolerance ||
           (outcome.iterations == 0 && outcome.residual > 0);
  };
  while (unfinished()) {
    if (outcome.iterations++ == options.max_iterations) {
      return internal::Failed(outcome, Status::kNoConvergence, "too many iterations");
    }
    if (!factored) {
      if (!linearized && !Linearize(problem, x, f, jacobian)) {
        return internal::Failed(outcome, Status::kOutOfDomain, "a derivative is not finite");
      }
      factors.compute(jacobian);
    }
    dx = factors.solve(-f);
    if (!dx.allFinite()) {
      return internal::Failed(outcome, Status::kNoConvergence, "the Jacobian is singular");
    }
    const double length = dx.norm();
    if (length > options.max_step) dx *= options.max_step / length;
    double norm = 0;
    bool taken = false;
    for (double t = 1; !taken && t > 1e-6; t /= 2) {
      trial = x + t * dx;
      norm = NormAt(problem, trial, trial_f);
      const double enough = options.damped ? 1 - 1e-4 * t : 0.5;
      taken = norm <= options.tolerance || norm <= enough * outcome.residual;
      if (!options.damped || factored) break;
    }
    if (taken) {
      factored = norm <= 0.05 * outcome.residual;
      linearized = false;
      x = trial;
      f = trial_f;
      outcome.residual = norm;
    } else if (factored) {
      factored = linearized = false;
    } else if (outcome.residual <= options.accept) {
      break;
    } else {
      return internal::Failed(outcome, Status::kNoConvergence, "no step reduces the residual");
    }
  }
  outcome.status = Status::kOk;
  return outcome;
}

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

struct PathOptions {
  double first_step = 0.25;
  double smallest_step = 1e-5;
  double largest_step = 1;
  int max_steps = 2000;
  double tolerance = 0;  ///< |f| on the way, where it is above that of the end
};

struct Anywhere {
  template <class X>
  bool operator()(const X&) const {
    return true;
  }
};

/// Follows the root of problem_at(load) from load 0 to 1, starting on the root x at load 0: secant
/// predictor, undamped Newton corrector, step halved when it fails and grown after quick success.
///
/// problem_at: double -> problem, for instance all loads multiplied by the argument. on_branch(x)
/// may refuse a root (say, an unstable one): the step is then halved as if there were none. On
/// failure (a limit point of the path) x is the last root found and `why` names the load it belongs
/// to.
template <class ProblemAt, int N, class OnBranch = Anywhere>
Outcome Continue(const ProblemAt& problem_at, Eigen::Matrix<double, N, 1>& x,
                 const Options& options = {}, const PathOptions& path = {},
                 const OnBranch& on_branch = {}) {
  using Vector = Eigen::Matrix<double, N, 1>;
  Options corrector = options;
  corrector.damped = false;
  corrector.max_iterations = 12;
  Outcome total;
  Vector previous = x, slope = Vector::Zero(x.size());
  double load = 0;
  double step = path.first_step;
  for (int i = 0; i < path.max_steps && load < 1; ++i) {
    const double next = load + step > 1 - 1e-9 ? 1 : load + step;
    Vector trial = x + (next - load) * slope;
    corrector.tolerance =
        next < 1 ? std::max(path.tolerance, options.tolerance) : options.tolerance;
    const Outcome outcome = Newton(problem_at(next), trial, corrector);
    total.iterations += outcome.iterations;
    if (outcome.ok() && on_branch(trial)) {
      previous = x;
      x = trial;
      slope = (x - previous) / (next - load);
      load = next;
      total.residual = outcome.residual;
      if (outcome.iterations <= 4) step = std::min(2 * step, path.largest_step);
    } else {
      step = (next - load) / 4;
      if (step < path.smallest_step) break;
    }
  }
  if (load >= 1) {
    total.status = Status::kOk;
    return total;
  }
  return internal::Failed(
      total, Status::kNoConvergence,
      "the path of equilibria ends at " + std::to_string(load) + " of the load");
}

}  // namespace continuum::statics
