#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/statics/measured_points.h"
#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// The measured disks of one case, in the measuring frame [m].
using Measured = statics::MeasuredPoints;
using statics::Find;

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

/// Of the cases, in their order.
std::vector<std::string> Names(const std::vector<Case>& cases);

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
