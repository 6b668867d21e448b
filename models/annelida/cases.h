#pragma once

#include <string>
#include <vector>

#include "models/annelida/statics.h"
#include "sim/io/csv.h"

namespace continuum {

/// One row of CASES.csv.
struct AnnelidaCase {
  std::string label;
  AnnelidaLoad load;
  Eigen::VectorXd length;  ///< of the cables, where they are given; else empty [m]
};

/// CASES.csv: `case`, then tensions F1.. [N] or lengths L1.. [m] of every cable; optional with
/// tensions `fx, fy, fz` [N] at the tip, base frame. @throws Error (file:line, column) for anything
/// missing, unknown or out of range.
std::vector<AnnelidaCase> ReadAnnelidaCases(const CsvTable& table, const AnnelidaParameters& p);

}  // namespace continuum
