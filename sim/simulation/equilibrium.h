#pragma once

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// The static equilibrium of a machine under the first inputs of a log, without friction and with
/// lags in their steady state. Newton's method from qpos0, the load in four steps. Throws Error
/// (kJob) when none is found.
InitialState Equilibrium(ModelAndData& machine, const Experiment& e, const Log& log);

}  // namespace continuum
