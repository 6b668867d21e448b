#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/io/csv.h"

namespace continuum::twin_pivot {

/// A path in the frame of the base's axis x: straight lines between points, before the first of
/// them the axis itself. s [m] is the length along it, 0 at the first point.
class PathLine {
 public:
  /// PATH.csv: `x, y, z` [m], a row for every point, the first on the axis; optional `low`, `high`:
  /// limits of every tension [N] when the tip stands there.
  /// @throws Error with file, line and column for bad input.
  explicit PathLine(const CsvTable& table);

  std::size_t points() const { return points_.size(); }
  double s(std::size_t point) const { return s_[point]; }
  double low(std::size_t point) const { return low_[point]; }
  double high(std::size_t point) const { return high_[point]; }

  Eigen::Vector3d At(double s) const;
  double Distance(const Eigen::Vector3d& from) const;
  /// Where a base stands when a robot of this length has its tip at a point: its x [m].
  /// @throws Error when the path has left the axis there.
  double Base(std::size_t point, double length) const;

 private:
  std::vector<std::string> where_;  ///< of every point, for messages
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> s_, low_, high_;
};

}  // namespace continuum::twin_pivot
