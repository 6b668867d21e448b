#pragma once

#include "models/statics/reach.h"

namespace continuum::statics {

/// The target's coordinates under drives, where there is a stable shape [m].
using PointsUnder = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& drives)>;

/// The drives w that bring the target's coordinates p near to values p* that need not be in reach,
/// by low tensions:
///
///   min |p(w) - p*|^2/length^2 + 1e-7 |w|^2/unit^2   with   low <= w <= high                  (1)
///
/// By Gauss-Newton from `start`; steps of at most `unit` that do not lower (1) are made shorter.
/// Where none does, as contacts turn back, single drives are changed by 1 to 30 % of their mean,
/// one at a time, and the search goes on from the best. `ok` when neither lowers (1) by a
/// thousandth, kNoConvergence after 40 rounds; drives are those of the last step, none where
/// `start` has no stable shape.
///
/// points(w): those of stand(w) alone, without their slopes, which cost as much as the shape.
Reached Nearest(const StandUnder& stand, const PointsUnder& points, const Eigen::VectorXd& start,
                const Target& target, double unit, double length);

}  // namespace continuum::statics
