#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "sim/io/interrupt.h"
#include "sim/numerics/work_limit.h"

namespace continuum::statics {

/// How a fall ended.
struct Fall {
  bool ok = false;      ///< at a stable equilibrium
  bool pushed = false;  ///< it began, or passed, where no force decides between two sides
  int steps = 0;
};

struct FallOptions {
  double tolerance = 1e-10;  ///< |residual| at rest
  double balanced = 1e-12;   ///< |residual| of a saddle that must be pushed
  double longest = 0.3;      ///< of a step, largest component
  double side = 1;           ///< of the push: 1 or -1
  int most_steps = 600;
};

/// A residual and its tangent at a shape, for Fall and SoftestMode. `System` has
///
///   bool Linearize(shape), ResidualAt(shape);  residual()          r, of the shape looked at last
///   bool Definite(shift)                      whether K + shift E falls back from every side
///   Step Solve(shift, b)                      (K + shift E) x = b
///   Step Unloaded(x)                          E x, E: stiffness without loads
///   Shape Moved(shape, step)
namespace internal {

constexpr double kStiffest = 1e12;  // of a shift

// The smallest shift, to a factor `close`, that makes the tangent definite; 0: it is.
template <class System>
double ShiftToDefinite(const System& system, double close) {
  if (system.Definite(0)) return 0;
  double below = 0, above = 1e-6;
  while (!system.Definite(above)) {
    below = above;
    above *= 4;
    numerics::WorkLimit::Spend();
    if (above > kStiffest) return above;
  }
  while (above > close * below && above > 1e-9) {
    const double middle = below > 0 ? std::sqrt(below * above) : above / 4;
    numerics::WorkLimit::Spend();
    (system.Definite(middle) ? above : below) = middle;
  }
  return above;
}

}  // namespace internal

/// The direction in which an unstable shape gives way most, of largest component 1: the lowest
/// mode of K x = -a E x, by inverse iteration. System::Linearize was called.
template <class System, class Step>
Step SoftestMode(const System& system, const Step& like) {
  const double shift = 1.02 * internal::ShiftToDefinite(system, 1.01) + 1e-9;
  Step mode = like;
  for (Eigen::Index i = 0; i < mode.size(); ++i) {  // no mode is orthogonal to this
    mode(i) = 1 + 0.3 * std::sin(1.7 * static_cast<double>(i) + 0.4);
  }
  for (int round = 0; round < 60; ++round) {
    numerics::WorkLimit::Spend();
    mode = system.Solve(shift, system.Unloaded(mode));
    Eigen::Index row = 0, column = 0;
    mode.cwiseAbs().maxCoeff(&row, &column);
    mode /= mode(row, column);
  }
  return mode;
}

/// The shape falls along E dx/dt = -r, an overdamped motion, until it rests at a stable
/// equilibrium: linearised implicit Euler,
///
///   (K + E/tau) dx = -r,
///
/// with tau so short that K + E/(2 tau) is definite (a longer one would climb back to the saddle)
/// and that r changes as the tangent says. At rest on a saddle the softest mode is pushed by 1e-3;
/// a shape that comes back from there is at rest, its tangent was off by as little.
template <class System, class Shape>
Fall FallToRest(System& system, Shape& shape, const FallOptions& options = {}) {
  using internal::kStiffest;
  constexpr double kPush = 1e-3, kBack = 5e-3;
  Fall fall;
  double shift = 1;
  double travelled = 1;  // since the last push
  bool pushed_before = false;
  bool linearized = system.Linearize(shape);
  while (linearized && ++fall.steps <= options.most_steps) {
    StopIfRequested();
    const auto r = system.residual();
    const double norm = r.norm();
    const bool stable = system.Definite(0);
    fall.ok = stable && norm <= options.tolerance;
    if (fall.ok) return fall;
    if (!stable && norm <= options.balanced) {
      if (travelled < kBack) {
        fall.ok = true;
        fall.pushed = pushed_before;
        return fall;
      }
      pushed_before = fall.pushed;
      fall.pushed = true;
      travelled = 0;
      shape = system.Moved(shape, kPush * options.side * SoftestMode(system, r));
      linearized = system.Linearize(shape);
      continue;
    }
    for (; !system.Definite(0.5 * shift); shift *= 2) {  // never of one that is not finite
      numerics::WorkLimit::Spend();
      if (shift > kStiffest) return fall;
    }
    for (bool taken = false; !taken; shift = taken ? shift / 3 : shift * 4) {
      if (shift > kStiffest) return fall;
      numerics::WorkLimit::Spend();
      const auto step = system.Solve(shift, -r);
      if (!(step.cwiseAbs().maxCoeff() <= options.longest)) continue;
      const Shape trial = system.Moved(shape, step);
      if (!system.ResidualAt(trial)) continue;
      const double error = (system.residual() + shift * system.Unloaded(step)).norm();
      taken = error <= 0.5 * norm || (stable && system.residual().norm() <= options.tolerance);
      if (taken) {
        shape = trial;
        travelled += step.cwiseAbs().maxCoeff();
      }
    }
    shift = std::max(shift, 1e-14);
    linearized = system.Linearize(shape);
  }
  return fall;
}

}  // namespace continuum::statics
