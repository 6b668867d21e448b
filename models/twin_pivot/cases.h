#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/twin_pivot/twin_pivot.h"
#include "sim/io/csv.h"

namespace continuum::twin_pivot {

/// One row of CASES.csv.
struct Case {
  std::string label;
  Load load;           ///< without its reference state
  int reference = -1;  ///< the row whose solution is l_ref; -1: straight
};

/// CASES.csv: `case`, then masses m1.. [kg] (tension 9.81 m), tensions F1.. [N] or lengths L1.. [m]
/// of every cable;
/// optional `condition` (I..V), `payload` [kg], `fx,fy,fz` [N], `Mx,My,Mz` [N m], the same and
/// `payload_k` at disc k as `fx_k` .. `Mz_k`, `gx,gy,gz` [m/s^2] (base frame), `reference` (label
/// of an earlier row).
/// @throws Error (file:line, column) for anything missing, unknown or out of range.
std::vector<Case> ReadCases(const CsvTable& table, const Robot& robot);
std::vector<Case> ReadCases(const std::filesystem::path& file, const Robot& robot);

}  // namespace continuum::twin_pivot
