#pragma once

#include "models/statics/details.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// Of a solution of the same case; outcome.ok(). The energy is that of bending and twist, plus
/// tensions at the base times the changes of the tendons' lengths, less the work of the dead loads:
///
///   int (u - u_0).K(u - u_0)/2 ds + sum T_k (l_k - l_k0) - sum F.(p - p_0),  K = (EI, EI, GJ)  (1)
///
/// l_k0: length of the tendon when nothing acts, p_0: place on the straight rod. Dead moments have
/// no part in it. Without friction an equilibrium is a stationary point of it.
statics::Details Describe(const Robot& robot, const Loads& loads, Method method,
                          const Solution& solution);

/// Of the tendons' paths along a rod with an even number of steps, by Simpson's rule [m].
Eigen::VectorXd TendonLengths(const Robot& robot, const Line& line);

/// The rod between base and tip.
Line LineOf(const Robot& robot, const Loads& loads, Method method, const Solution& solution);

}  // namespace continuum::tdcr
