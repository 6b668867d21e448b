#pragma once

#include <vector>

#include "models/stiff_flop/log.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {

/// What acts of a line's pressure p, where the symmetric static module takes all of it:
///
///   q_i = gain_i max(p_i - dead, 0)                                  (1)
///   acting_i = (1 - creep) q_i + creep z_i,  z_i' = (q_i - z_i)/lag   (2)
///
/// (1) tubes are not equal, and each must first fill its chamber; (2) the silicone creeps.
/// Pressures are linear between rows for (2), which is then exact.
struct Lines {
  Eigen::Vector3d gain = Eigen::Vector3d::Ones();
  double dead = 0;   ///< [Pa]
  double creep = 0;  ///< share that follows later, 0 <= creep < 1
  double lag = 2;    ///< [s]

  /// The log with acting pressures in the place of the measured ones, at rest before its first row.
  Log Acting(const Log& log) const;
};

/// Which of them are fitted.
struct LineEffects {
  bool gain = false, dead = false, creep = false;
};

/// Least squared marker distance over the train rows, registration fitted for each guess.
numerics::Outcome FitLines(const Robot& robot, const Method& method, const Log& log,
                           const LineEffects& effects, Lines& lines);

}  // namespace continuum::stiff_flop
