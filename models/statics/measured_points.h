#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "sim/io/csv.h"

namespace continuum::statics {

/// The measured disks of one case [m].
struct MeasuredPoints {
  std::string name;
  bool test = false;       ///< kept out of calibration and training
  Eigen::Matrix3Xd disks;  ///< 3 x n, a column of NaN: not measured

  bool Has(Eigen::Index disk) const { return !std::isnan(disks(0, disk)); }
  int count() const;
};

/// Reads MEASURED.csv: `case`; `x_i, y_i, z_i` of any disks 1..disks, or `x, y, z` of the tip,
/// which is the last one; `use`: train (default) or test. Empty cells: not measured.
/// @throws Error with file, line and column: another column, a point that is not whole, the tip
/// twice, a name twice, a row without any point, no row.
std::vector<MeasuredPoints> ReadMeasuredPoints(const CsvTable& table, int disks);

/// The row of that name, or nothing.
const MeasuredPoints* Find(const std::vector<MeasuredPoints>& measured, const std::string& name);

/// @throws Error, naming the file of the points, when none of the cases was measured.
void RequireShared(const std::vector<std::string>& cases,
                   const std::vector<MeasuredPoints>& measured, const std::string& file);

}  // namespace continuum::statics
