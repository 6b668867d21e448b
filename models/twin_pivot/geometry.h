#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "models/twin_pivot/joint.h"
#include "models/twin_pivot/robot.h"

/// The robot's shape from the angles beta_m [rad] of its joints.
namespace continuum::twin_pivot {

/// What depends on the angle of each joint alone.
std::vector<Joint<double>> JointsAt(const Robot& robot, const Eigen::VectorXd& beta);

/// Cable lengths l_mj [m], joints x cables, 0 beyond the anchor.
Eigen::MatrixXd CableLengths(const Robot& robot, const Eigen::VectorXd& beta);

/// Frames of the discs 0 .. n in the base frame: origin O_m [m], x along the normal.
std::vector<Eigen::Isometry3d> DiscFrames(const Robot& robot, const Eigen::VectorXd& beta);

/// Points of the centre line in the base frame [m]: O_0, then for each joint `per_rod` points along
/// the rod (its two ends included) and O_m.
std::vector<Eigen::Vector3d> CentreLine(const Robot& robot, const Eigen::VectorXd& beta,
                                        int per_rod = 6);

}  // namespace continuum::twin_pivot
