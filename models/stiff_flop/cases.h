#pragma once

#include "models/stiff_flop/case.h"
#include "sim/io/csv.h"

namespace continuum::stiff_flop {

/// As Cases::Read, of a table that has been read.
Cases ReadCases(const CsvTable& table, const Eigen::Vector3d& gravity);

}  // namespace continuum::stiff_flop
