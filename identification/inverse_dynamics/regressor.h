#pragma once

#include "identification/inverse_dynamics/regressor_options.h"
#include "identification/problem/problem.h"
#include "identification/result/regression.h"

namespace continuum {

/// Least squares on the inverse dynamics along the measured motion, without a simulation
/// (MeasuredEquations; gautier1997, janot2014), in three steps as spa2022 (section V):
///
/// 1. What forces and torques of the base depend on, such as the mass, from these alone, where they
///    distinguish all of it.
/// 2. A particle swarm within the bounds over parameters that enter the joints' equations along a
///    curve, with linear least squares for all others inside. Without such parameters: only these.
/// 3. After a swarm Gauss-Newton of all parameters of step 2, from its best place.
///
/// Within the bounds, which stand for the source's penalty: least squares inside the swarm keep to
/// them too. Where dry friction may hold a joint, its equation is left out (MarkStationary), but
/// counts in the errors.
///
/// Throws Error for motion that is not measured, states that cannot be (laws with states, cable
/// friction), and parameters that nothing determines.
Regression FitByRegressor(const Problem& problem, const std::vector<bool>& use,
                          const RegressorOptions& options = {});

}  // namespace continuum
