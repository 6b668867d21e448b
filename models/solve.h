#pragma once

#include "models/statics/solve_request.h"

namespace continuum {

/// Solves the statics of a robot: hands the request to the model that the key `robot` (stiff_flop:
/// `model`) of the YAML file names. @returns 0 when every case was solved, 1 when the results were
/// written but some case failed. @throws Error for bad input (nothing is written then).
int Solve(const SolveRequest& request);

}  // namespace continuum
