#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "sim/numerics/linearize.h"
#include "sim/numerics/solver.h"
#include "sim/numerics/work_limit.h"

namespace continuum::numerics {
namespace internal {

template <class Problem, class Matrix>
struct FactorsOf {
  using type = Eigen::PartialPivLU<Matrix>;
};
template <class Problem, class Matrix>
requires(Matrix::RowsAtCompileTime == Eigen::Dynamic &&
         requires { typename Problem::Factors; }) struct FactorsOf<Problem, Matrix> {
  using type = typename Problem::Factors;
};

}  // namespace internal

/// Factors of the J of a problem of N unknowns.
template <class Problem, int N>
using FactorsFor = typename internal::FactorsOf<Problem, Eigen::Matrix<double, N, N>>::type;

/// Damped Newton for as many equations as unknowns, from x to x: J dx = -f, |dx| <= max_step, then
/// halved until |f| falls by the Armijo rule (1e-4) and the point is in the domain. A factored J is
/// used again for as long as a step with it leaves less than a twentieth of |f|. One step is taken
/// even from within the tolerance, so that answers to small loads keep their digits.
///
/// A problem of any number of unknowns that knows more of its J has a type `Factors` with
/// compute(J) and solve(b).
///
/// With `damped` false it takes full steps and gives up as soon as one does not halve |f|: it then
/// stays on the branch it was started on. x is left at the best point, also on failure. `factors`
/// are left as those of the last J, which is that of a point near the root; untouched where no
/// iteration was needed.
template <class Problem, int N>
Outcome Newton(const Problem& problem, Eigen::Matrix<double, N, 1>& x, const Options& options,
               FactorsFor<Problem, N>& factors) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Outcome outcome;
  Vector f = Vector::Zero(x.size()), trial_f = f, trial = f, dx = f;
  Matrix jacobian(x.size(), x.size());
  if (!Linearize(problem, x, f, jacobian)) {
    return internal::Failed(outcome, Status::kOutOfDomain, "the start is out of the domain");
  }
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
    WorkLimit::Spend();
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

template <class Problem, int N>
Outcome Newton(const Problem& problem, Eigen::Matrix<double, N, 1>& x,
               const Options& options = {}) {
  FactorsFor<Problem, N> factors(x.size());
  return Newton(problem, x, options, factors);
}

}  // namespace continuum::numerics
