#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/tdcr/disks.h"

namespace continuum::tdcr {

/// Arcs from disk to disk whose curvature is linear over the arcs of each section, (1): the
/// unknowns are (kappa_x, kappa_y, tau) of its first and of its last arc, section after section
/// [1/m]. A section of one arc has the mean of both.
class LinearCurvature {
 public:
  explicit LinearCurvature(const Robot& robot);

  Eigen::Index unknowns() const { return 6 * sections_; }
  int arcs() const { return static_cast<int>(arcs_.size()); }

  /// Of the arcs, 3 x n.
  Eigen::Matrix3Xd Curvatures(const Eigen::VectorXd& ends) const;
  /// O_1..O_n of arcs with curvatures u [m].
  Eigen::Matrix3Xd Positions(const Eigen::Matrix3Xd& u) const;
  /// dO_i/d(unknowns), 3 x unknowns for i = 1..n, where the arcs have curvatures u.
  std::vector<Eigen::Matrix3Xd> Gradient(const Eigen::Matrix3Xd& u) const;

 private:
  struct OneArc {
    double length;
    Eigen::Index first;  ///< column of its section's first end
    double share;        ///< of the last end
  };
  std::vector<OneArc> arcs_;
  Eigen::Index sections_;
};

}  // namespace continuum::tdcr
