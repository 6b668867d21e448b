#pragma once

#include <Eigen/Core>

#include "models/tdcr/cosserat.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/equilibrium.h"

namespace continuum::tdcr {

/// The equilibrium of tendons wound to loads.length (statics::FollowLengths), from x and tension
/// [N] to x and tension, where the winches stood at `from` [m]. The rod is one whose contacts
/// remember.
template <int C>
Found FindByWinches(const Robot& robot, const Loads& loads, const Eigen::VectorXd& from,
                    DiskBalance<C>& balance, typename DiskBalance<C>::Vector& x,
                    Eigen::VectorXd& tension);
Found FindByWinches(const Robot& robot, const Loads& loads, const Eigen::VectorXd& from,
                    RodBalance& balance, Eigen::VectorXd& x, Eigen::VectorXd& tension);

}  // namespace continuum::tdcr
