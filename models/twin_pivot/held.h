#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/statics/held.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// What a solved case holds beside its shape.
struct Held {
  statics::Hold hold;
  Eigen::VectorXd length;  ///< of every cable between the discs' faces, 0 to anchor [m]
  /// Of the rods, plus F_SC times the cables' lengths, less the work of weights and tip force [J];
  /// 0 of the straight robot. NaN with a moment of fixed direction, which has no potential.
  double energy;
};

/// Of a solution of the same case; outcome.ok().
Held Describe(const Robot& robot, const Load& load, const Solution& solution);

/// The energy of Held at any angles.
double Energy(const Robot& robot, const Load& load, const Eigen::VectorXd& beta);

/// Places along the centre line: the discs' centres, and `per_rod` on every rod.
std::vector<statics::ShapeTable::Place> Places(const Robot& robot, const Solution& solution,
                                               int per_rod = 3);

}  // namespace continuum::twin_pivot
