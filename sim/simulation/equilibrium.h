#pragma once

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// Static equilibrium under the first inputs, without friction, lags settled. Throws Error (kJob)
/// when there is none near qpos0.
InitialState Equilibrium(ModelAndData& machine, const Experiment& e, const Log& log);

}  // namespace continuum
