#pragma once

#include <chrono>
#include <limits>
#include <string>
#include <utility>

/// Roots and least squares of small dense systems, shared by all fits and static models.
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
/// Scale the residuals so that their norm means something (the statics divide by EI/L): tolerances
/// are absolute norms. Fixed sizes never touch the heap while iterating.
namespace continuum::numerics {

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

namespace internal {

inline Outcome Failed(Outcome outcome, Status status, std::string why) {
  outcome.status = status;
  outcome.why = std::move(why);
  return outcome;
}

}  // namespace internal

}  // namespace continuum::numerics
