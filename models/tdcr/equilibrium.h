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

/// Whether the loads are so far from buckling that they leave one equilibrium.
bool OneEquilibrium(const Robot& robot, const Loads& loads);

/// An equilibrium and what is known about it.
struct Found {
  numerics::Outcome outcome;
  statics::Stability stability;
};

/// The equilibrium of the rising load (statics.md), from x to x: of the balances of disks, and of
/// the rod (dynamic x: with contacts that remember). With `start`, Newton from there first. A
/// saddle is never `ok`.
///
/// ContinueEquilibrium follows the loads of a balance that grow from others, from their x.
template <int C>
Found FindEquilibrium(const Robot& robot, const Loads& loads, DiskBalance<C>& balance,
                      typename DiskBalance<C>::Vector& x, const Eigen::VectorXd* start);
template <int C>
Found ContinueEquilibrium(const Robot& robot, const Loads& loads, DiskBalance<C>& balance,
                          typename DiskBalance<C>::Vector& x);
Found FindEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance,
                      Eigen::Vector3d& x, const Eigen::VectorXd* start);
Found FindEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance,
                      Eigen::VectorXd& x, const Eigen::VectorXd* start);
Found ContinueEquilibrium(const Robot& robot, const Loads& loads, RodBalance& balance,
                          Eigen::VectorXd& x);

/// Newton at full load from x, for a root that is only to be made more exact.
template <class Balance, class Vector>
numerics::Outcome Polish(const Balance& balance, Vector& x);

/// Directions in which the root x gives way: of disks at full load, of the rod at its load and with
/// winches (RodLaw::SetWinches) where they are given.
template <int C>
int UnstableDirections(DiskBalance<C>& balance, const typename DiskBalance<C>::Vector& x);
template <class Vector>
int UnstableDirections(const Robot& robot, RodBalance& balance, const Vector& x,
                       const Eigen::VectorXd& winches = {});

}  // namespace continuum::tdcr
