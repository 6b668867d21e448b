#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include "models/statics/results.h"

namespace continuum::statics {

/// A place along the axis of a solved case, base frame.
struct Place {
  double s;               ///< way along the axis without loads [m]
  int disk;               ///< that is there; -1: none
  Eigen::Vector3d point;  ///< [m]
  Eigen::Quaterniond frame;
  Eigen::VectorXd tension;  ///< of every cable from there on [N]
};

/// Places along the axes of solved cases (--shape): `case`, `s`, `disk` (empty between disks),
/// `x, y, z`, `qw..qz`, `T_1..T_m`.
class ShapeTable {
 public:
  explicit ShapeTable(int cables);

  void Add(const std::string& name, const Place& place);
  /// By extension, as Results.
  void Write(const std::filesystem::path& path) const { results_.Write(path); }

 private:
  Results results_;
};

}  // namespace continuum::statics
