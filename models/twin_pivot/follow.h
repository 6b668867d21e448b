#pragma once

#include <vector>

#include "models/twin_pivot/path_line.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// The robot with its tip at a point of a path and the rest of it along the path behind.
struct Following {
  Load load;  ///< tensions, and the contacts' state that the solution goes on from
  Solution solution;
  bool settled = false;  ///< no step comes nearer by more than a thousandth
  double base = 0;       ///< place of O_0 along the base's axis, x of the path's frame [m]
  double miss = 0;       ///< root mean square over the discs of what they are off their points [m]
  Eigen::VectorXd off;   ///< distance of every disc from the path [m]
};

/// Follow the leader: the base comes along its axis, so that the tip reaches one point after the
/// other. Disc m belongs on the path at s_m = s_tip - (its distance from the tip when straight).
/// Tensions are those of statics::Nearest, from the ones before. Dead loads are those of `load`, in
/// the base frame, and its tensions are where the search of the first point begins. Contacts go on
/// from point to point; after a point without a stable shape they go on from the one before it.
std::vector<Following> Follow(const Robot& robot, const Load& load, Method method,
                              const PathLine& path);

}  // namespace continuum::twin_pivot
