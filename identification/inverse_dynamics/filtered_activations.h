#pragma once

#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// What keeps activations from being known without a simulation ("actuator 'u' has dynamics other
/// than a first-order lag"); empty: nothing.
std::string ActivationObstacle(const mjModel& m);

/// Activations [activation][row] of first-order lags under the inputs of a log,
///
///   T ẇ = u − w,   w(0) = u(0)
///
/// with u held between rows or linear, in closed form, and low-passed without phase as positions
/// are (cutoff: share of the rows' rate). An eighth of the rows' period lies between the numbers
/// that are filtered, as a lag bends where its input jumps.
std::vector<std::vector<double>> FilteredActivations(const Experiment& e, const mjModel& m,
                                                     const Log& log, const Wiring& wiring,
                                                     double cutoff);

}  // namespace continuum
