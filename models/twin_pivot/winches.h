#pragma once

#include <Eigen/Core>

#include "models/statics/rising_load.h"
#include "models/twin_pivot/balance.h"

namespace continuum::twin_pivot {

/// The equilibrium of cables wound to `given` between the discs' faces (statics::FollowLengths),
/// from beta and tension [N] to those, where the winches stood at `before` [m]; dead loads go from
/// those of one task to those of the other.
numerics::Outcome FollowWinches(const Task& from, const Task& to, const Eigen::VectorXd& before,
                                const Eigen::VectorXd& given, Eigen::VectorXd& beta,
                                Eigen::VectorXd& tension, statics::Stability& stability);

}  // namespace continuum::twin_pivot
