#pragma once

#include <Eigen/Core>

#include "models/statics/rising_load.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/robot.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {

/// Dead forces below this [EI/L^2] leave one equilibrium; Euler's clamped column: pi^2/4.
inline constexpr double kOneEquilibrium = 2.4;

/// An equilibrium and what is known about it.
struct Found {
  numerics::Outcome outcome;
  statics::Stability stability;
};

/// The equilibrium of the rising load (statics.md), from x to x: of the balances of disks, and of
/// the rod with `direct` for loads so small that there is one equilibrium. With `start`, Newton
/// from there first. A saddle is never `ok`.
///
/// ContinueEquilibrium follows the loads of a balance that grow from others, from their x.
template <int C>
Found FindEquilibrium(const Robot& robot, const Loads& loads, DiskBalance<C>& balance,
                      typename DiskBalance<C>::Vector& x, const Eigen::VectorXd* start);
template <int C>
Found ContinueEquilibrium(const Robot& robot, const Loads& loads, DiskBalance<C>& balance,
                          typename DiskBalance<C>::Vector& x);
Found FindEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance, bool friction,
                      Eigen::Vector3d& x, const Eigen::VectorXd* start);

/// Newton at full load from x, for a root that is only to be made more exact.
numerics::Outcome Polish(const RodBalance& balance, Eigen::Vector3d& x);

}  // namespace continuum::tdcr
