#pragma once

#include "identification/fit/bounded_least_squares.h"

namespace continuum {

/// As Minimize, at a fraction of the simulations: the slopes are made once, at the start.
///
/// Every step, taken or not, then tells by how much it was wrong, and the slopes along it follow
/// (Broyden 1965): over a distance at which joints stick and slip, where slopes at a point say
/// little. They are made anew only where no step promises more, to see whether that is so.
///   (JᵀJ + λ diag JᵀJ) s = −Jᵀr,   J += (r(y + s) − r(y) − J s) sᵀ/sᵀs
/// slopes: J at the start if it has columns, else made there; J at the end.
ceres::Solver::Summary MinimizeBySecants(const ceres::CostFunction& cost, const Box& box,
                                         const Search& search, Problem::Vector& y,
                                         Problem::Matrix& slopes);

}  // namespace continuum
