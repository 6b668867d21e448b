#pragma once

#include <Eigen/Core>

#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// The Euler arc spline nearest to measured disks, (8): u_1, u_n that minimise
/// sum |x_k - O_k|^2 + lambda (|u_1|^2 + |u_n|^2) [m^2]. Of a robot with sections each has its own
/// u_1 and u_n.
///
/// points: 3 x n in the base frame [m], NaN columns left out. From the straight rod and from the
/// arc of constant curvature through the last point, the better of the two. The outcome's residual
/// is the gradient of (8) by L u, over L^2.
Solution FitShape(const Robot& robot, const Eigen::Matrix3Xd& points, double lambda);

}  // namespace continuum::tdcr
