#pragma once

#include "models/statics/solve_request.h"

namespace continuum {

/// `continuum solve` for one segment driven by tendons. @returns 0 when every case was solved, 1
/// when the results were written but some case failed. @throws Error for bad input (nothing is
/// written then).
int SolveTdcr(const SolveRequest& request);

}  // namespace continuum
