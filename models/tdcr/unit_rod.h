#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// A rod and what acts on it, in units of its length L and of EI/L. s from the base (0) to the tip
/// (1).
struct UnitRod {
  /// friction: of tendons in their holes, where the loads have any. Slack tendons do nothing and
  /// are left out unless `all` are asked for.
  UnitRod(const Robot& robot, const Loads& loads, bool friction, bool all = false);

  /// The loads of `to` times `share` and those of `from` times the rest; both have the tendons of
  /// this one.
  void Mix(const UnitRod& from, const UnitRod& to, double share);
  /// No load at all.
  UnitRod Unloaded() const;

  /// Dead force on a section with so many disks in front of it, towards the base.
  Eigen::Vector3d Force(int passed, double s) const {
    return tip_force + (disks - passed) * disk_weight + (1 - s) * rod_weight;
  }

  double twist;  ///< GJ/EI
  double mu;
  bool friction;
  int disks;
  std::vector<int> tendon;  ///< which of the robot's, of the vectors below
  std::vector<Eigen::Vector2d> holes;
  std::vector<double> pull;  ///< at the base, times L^2/EI, as the forces below
  std::vector<int> direction;
  Eigen::Vector3d natural;  ///< u of the rod when nothing acts
  Eigen::Vector3d tip_force, disk_weight, rod_weight;
};

}  // namespace continuum::tdcr
