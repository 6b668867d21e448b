#pragma once

#include <vector>

#include "models/twin_pivot/path_line.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// The robot with its tip at a point of a path and the rest of it along the path behind.
struct Following {
  Load load;  ///< tensions, and the contacts' state that the solution goes on from
  Solution solution;
  double base = 0;      ///< place of O_0 along the base's axis, x of the path's frame [m]
  double miss = 0;      ///< root mean square over the discs of what they are off their points [m]
  Eigen::VectorXd off;  ///< distance of every disc from the path [m]
};

/// Follow the leader: the base comes along its axis, so that the tip reaches one point after the
/// other. Disc m belongs at s_tip - (its distance from the tip along the straight robot), and
///
///   min |F|^2   with   F among the minima of sum_m |O_m - p(s_m)|^2,  low <= F <= high      (1)
///
/// as statics::Nearest finds it from the tensions before. Dead loads are those of `load`, in the
/// base frame, and its tensions are where the search of the first point begins. Contacts go on from
/// point to point; a point that fails leaves its place to the one before.
std::vector<Following> Follow(const Robot& robot, const Load& load, Method method,
                              const PathLine& path);

}  // namespace continuum::twin_pivot
