#pragma once

#include "models/statics/solve_request.h"
#include "sim/io/csv.h"

namespace continuum::statics {

/// The cases of a request: the table of --input, or with --sweep the grid between its two rows.
CsvTable CasesOf(const SolveRequest& request);

/// All combinations of `values` equally distant numbers from the first to the second row, in every
/// column whose two cells differ; the other columns stay as they are. `case` counts from 1, the
/// last column changes fastest. @throws Error for a table of other than two rows, for texts that
/// differ, and for more than a million cases.
CsvTable Grid(const CsvTable& corners, int values);

}  // namespace continuum::statics
