#pragma once

#include "models/statics/solve_request.h"

namespace continuum {

/// `continuum solve` for the snake arm. Methods: constant_curvature (default), chain,
/// chain_friction. @returns 0 when every case was solved, 1 when the results were written but some
/// case failed. @throws Error for bad input (nothing is written then).
int SolveAnnelida(const SolveRequest& request);

}  // namespace continuum
