#pragma once

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// Hours of computing for the smallest model; and an int counts them.
inline constexpr double kMostSteps = 1e9;

/// Throws Error when a log has more steps than anybody can wait for (times in a wrong unit).
void CheckLength(const Log& log, double timestep);

/// Runs one log through a machine (whose model is changed on the way): inputs held between rows or
/// linear, a row active at its own time (the crossing step is shortened), channels those of the
/// state at the row's time.
///
/// A simulation that diverges ends there: diverged is set, the rest of the channels is NaN.
Trace Simulate(ModelAndData& machine, const Experiment& e, const Log& log,
               const InitialState& initial = {}, const Hooks& hooks = {});

}  // namespace continuum
