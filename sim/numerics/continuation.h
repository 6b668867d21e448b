#pragma once

#include <algorithm>
#include <string>

#include "sim/numerics/newton.h"

namespace continuum::numerics {

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

}  // namespace continuum::numerics
