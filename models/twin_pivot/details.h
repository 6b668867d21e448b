#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/statics/details.h"
#include "models/statics/shape_table.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// Of a solution of the same case; outcome.ok(). Lengths are those between the discs' faces, from
/// base to anchor.
statics::Details Describe(const Robot& robot, const Load& load, const Solution& solution);

/// Of the most strained fibre of the rods, bent to arcs: d beta/(2 L).
double Strain(const Robot& robot, const Eigen::VectorXd& beta);

/// Energy at any angles [J]: of the rods, plus tensions times the changes of the cables' lengths,
/// less the work of weights and forces on discs,
///
///   rods E I_z/L sum beta^2/2 + sum F_SC (l - l_0) - sum W.(p - p_0) (1)
///
/// NaN with a moment of fixed direction, which has no potential.
double Energy(const Robot& robot, const Load& load, const Eigen::VectorXd& beta);

/// Places along the centre line: the discs' centres, and `per_rod` on every rod.
std::vector<statics::Place> Places(const Robot& robot, const Solution& solution, int per_rod = 3);

}  // namespace continuum::twin_pivot
