#pragma once

#include <Eigen/Core>

namespace continuum::statics {

/// The w within low <= w <= high that minimises w.H w/2 - g.w, H positive definite.
///
/// By active sets: the free unknowns are solved for, those that leave their limits are held there
/// one by one, and those whose multiplier has the wrong sign are set free again.
/// Source: Stark, Parker, "Bounded-variable least squares: an algorithm and applications",
/// Computational Statistics 10, 1995.
Eigen::VectorXd WithinLimits(const Eigen::MatrixXd& H, const Eigen::VectorXd& g,
                             const Eigen::VectorXd& low, const Eigen::VectorXd& high);

}  // namespace continuum::statics
