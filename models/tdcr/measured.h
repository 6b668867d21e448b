#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/tdcr/robot.h"
#include "sim/io/csv.h"

namespace continuum::tdcr {

/// The measured disks of one case, in the measuring frame [m].
struct Measured {
  std::string name;
  bool test = false;       ///< kept out of calibration and training
  Eigen::Matrix3Xd disks;  ///< 3 x n, a column of NaN: not measured

  bool Has(int disk) const { return !std::isnan(disks(0, disk)); }
  int count() const;
};

/// Reads MEASURED.csv. @throws Error with file, line and column: a point that is not whole, a disk
/// that the robot lacks, a name twice, a row without any point, no row.
std::vector<Measured> ReadMeasured(const CsvTable& table, int disks);

/// The row of that name, or nothing.
const Measured* Find(const std::vector<Measured>& measured, const std::string& name);

/// Distance between R^c x_i and O_i [m] for every disk, NaN where not measured.
Eigen::VectorXd Errors(const Robot& robot, const Measured& measured, const Eigen::Matrix3Xd& disks);

/// Mean, sample standard deviation and range.
struct Spread {
  double mean = 0, std = 0, min = 0, max = 0;
};
/// Nothing for no values.
std::optional<Spread> Statistics(const std::vector<double>& values);

/// Tip errors in % of the robot's length, of the cases for training and the others.
struct TipErrors {
  std::vector<double> train, test;

  /// Adds a case if its tip was measured.
  void Add(const Robot& robot, const Measured& measured, const Eigen::Matrix3Xd& disks);
};

/// @throws Error when no case was measured.
void RequireShared(const std::vector<Case>& cases, const std::vector<Measured>& measured,
                   const std::string& file);

/// A case with its measurement.
struct Pair {
  const Case* loads;
  const Measured* measured;
};
/// All cases that were measured, in the order of the cases. @throws Error when there are none or
/// when none is for training.
std::vector<Pair> Match(const std::vector<Case>& cases, const std::vector<Measured>& measured,
                        const std::string& file);

}  // namespace continuum::tdcr
