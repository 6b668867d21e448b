#pragma once

#include <Eigen/Core>

#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"

namespace continuum::numerics {

/// Newton's method that keeps the factors of its last J, which is that of a point near the root: so
/// the rate of the root costs no J of its own.
template <class Factors, int N>
class LastTangent {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit LastTangent(Eigen::Index n) : factors_(n) {}

  template <class Problem>
  Outcome Newton(const Problem& problem, Vector& x, const Options& options) {
    const Outcome outcome = numerics::Newton(problem, x, options, factors_);
    known_ = known_ || outcome.iterations > 0;
    return outcome;
  }

  /// dx/dt of the root x of f(x, t), of which `by_t` is df/dt: by the last J or, `exact`, by that
  /// of x. 0 where x is out of the domain.
  template <class Problem>
  Vector Rate(const Problem& problem, const Vector& x, const Vector& by_t, bool exact) {
    if (by_t.isZero(0)) return by_t;
    if (exact || !known_) {
      Vector f(x.size());
      Eigen::Matrix<double, N, N> jacobian(x.size(), x.size());
      if (!Linearize(problem, x, f, jacobian)) return Vector::Zero(x.size());
      factors_.compute(jacobian);
      known_ = true;
    }
    return factors_.solve(-by_t);
  }

 private:
  Factors factors_;
  bool known_ = false;
};

/// The same for one kind of problem.
template <class Problem, int N>
using LastTangentOf = LastTangent<FactorsFor<Problem, N>, N>;

}  // namespace continuum::numerics
