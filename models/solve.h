#pragma once

#include <istream>
#include <ostream>

#include "models/statics/solve_request.h"

namespace continuum {

/// Solves the statics of a robot: hands the request to the model that the key `robot` (stiff_flop:
/// `model`) of the YAML file names. @returns 0 when every case was solved, 1 when the results were
/// written but some case failed. @throws Error for bad input (nothing is written then).
int Solve(const SolveRequest& request);

/// The same of a stream: `in` has a header and rows of cases, `out` gets the header of the results
/// and then the rows of every case as soon as it is solved. Rows that have come together are solved
/// together, on all cores, unless a column `reference` lets them go on from one another: then each
/// stands alone. A case costs no start of a process. @returns the largest code of its rows. @throws
/// Error as Solve, and for an option that needs all cases at once.
int SolveStream(const SolveRequest& request, std::istream& in, std::ostream& out);

}  // namespace continuum
