#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "models/statics/relax.h"
#include "models/statics/turning.h"
#include "sim/numerics/solver.h"
#include "sim/numerics/work_limit.h"

namespace continuum::statics {

/// Which equilibrium an answer is (the column `branch`): `rising`, the one that the rising load
/// reaches; `symmetric`, one of two that mirror each other, as no load decides; `other`, one that
/// was found otherwise.
enum class Branch { kRising, kSymmetric, kOther };

inline const char* Name(Branch branch) {
  return branch == Branch::kRising      ? "rising"
         : branch == Branch::kSymmetric ? "symmetric"
                                        : "other";
}

/// How stable an answer is.
struct Stability {
  int unstable_directions = 0;
  Branch branch = Branch::kRising;

  bool stable() const { return unstable_directions == 0; }
};

struct RisingOptions {
  double first_step = 0.1, largest_step = 0.2;  ///< of the load
  double smallest_step = 1e-4;                  ///< below it the path has an end: the shape falls
  double shortest_way = 1e-3;                   ///< of the load, to where a contact turns back
  double trust = 0.3;  ///< of the corrector: |x - predicted|, root mean square
  int most_steps = 2000;
};

/// Where a row was given up.
inline std::string AtShare(double load) {
  return "at " + std::to_string(load) + " of the rising load";
}

/// The equilibrium that is reached when all loads grow together from 0 to 1, from x = 0.
///
/// `System` has `Correct(load, x)`, an outcome of a Newton method that stays near where it starts;
/// `Unstable(load, x)`, the number of directions in which the root x gives way; and `Fall(from,
/// load, x)`, which lets the root x at one load fall to a stable one at the next (statics::Fall).
/// Steps that end at an unstable root, or far from the secant, are made shorter. Where none is
/// short enough the path has an end, a fold or a fork: the shape falls at a load just beyond it and
/// the path goes on from there. Of a Remembering system steps are cut where contacts turn back, and
/// contacts go on from step to step.
template <class System, class Vector>
numerics::Outcome FollowRisingLoad(System& system, Vector& x, Branch& branch,
                                   const RisingOptions& options = {}) {
  numerics::Outcome total;
  Vector slope = Vector::Zero(x.size());
  Turning<System, Vector> turning(system);
  double load = 0, step = options.first_step;
  const double trust = options.trust * std::sqrt(static_cast<double>(x.size()));
  const auto falls = [&] {
    for (double beyond = options.smallest_step; beyond < 0.1; beyond *= 2) {
      const double next = std::min(1.0, load + beyond);
      Vector trial = x;
      const Fall fall = system.Fall(load, next, trial);
      total.iterations += fall.steps;
      if (!fall.ok) continue;
      if (fall.pushed) branch = Branch::kSymmetric;
      x = trial;
      load = next;
      slope.setZero();
      step = options.smallest_step;
      turning.Fallen();
      return true;
    }
    return false;
  };
  const auto rises = [&] {
    const double next = load + step > 1 - 1e-9 ? 1 : load + step;
    const Vector predicted = x + (next - load) * slope;
    Vector trial = predicted;
    const numerics::Outcome outcome = system.Correct(next, trial);
    total.iterations += outcome.iterations;
    if (outcome.ok() && (trial - predicted).norm() <= trust && system.Unstable(next, trial) == 0) {
      const double share = turning.Share(load, x, next, trial);
      if (share < 1 && next - load > 1.5 * options.shortest_way) {
        step = std::max(share * (next - load), options.shortest_way);
        return true;
      }
      slope = (trial - x) / (next - load);
      x = trial;
      load = next;
      total.residual = outcome.residual;
      if (load < 1) turning.GoOnFrom(x);
      if (outcome.iterations <= 4) step = std::min(2 * step, options.largest_step);
      return true;
    }
    step = (next - load) / 4;
    return step >= options.smallest_step || falls();
  };
  try {
    for (int i = 0; i < options.most_steps && load < 1; ++i) {
      if (!rises()) break;
    }
  } catch (numerics::GaveUp& at) {
    at.where = AtShare(load);
    throw;
  }
  if (load >= 1) {
    total.status = numerics::Status::kOk;
    return total;
  }
  return numerics::internal::Failed(
      total, numerics::Status::kNoConvergence,
      "the rising load ends at " + std::to_string(load) + " of it, and no stable shape was found");
}

}  // namespace continuum::statics
