#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// The rod at some places from base to tip, base frame.
struct Line {
  Eigen::VectorXd s;                       ///< way along the rod [m]
  Eigen::Matrix3Xd points;                 ///< [m]
  std::vector<Eigen::Quaterniond> frames;  ///< z along the rod
  std::vector<int> disk;                   ///< the one that is there; 0 is the base, -1: none
  Eigen::Matrix3Xd u;                      ///< R' = R [u]x, from the place on [1/m]
  Eigen::Matrix3Xd ends;                   ///< u where arcs end, just before the disks [1/m]
  Eigen::MatrixXd tension;                 ///< of every tendon there, towards the tip [N]
};

/// That of arcs of constant curvature (columns of u: kappa_x, kappa_y, tau), each at `per_arc` + 1
/// places. tension: of every tendon in every arc.
Line LineOfArcs(const Robot& robot, const Eigen::Matrix3Xd& u, const Eigen::MatrixXd& tension,
                int per_arc = 4);

}  // namespace continuum::tdcr
