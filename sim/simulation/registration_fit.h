#pragma once

#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// What a registration leaves to be estimated, as parameters of a fit, from its present values.
std::vector<Parameter> RegistrationParameters(const Experiment& e, const Wiring& wiring,
                                              const mjModel& m);

/// Least squares of what the registration leaves to be estimated, over the train logs; traces: of
/// all logs, as simulated. The frame starts from the closed form (Kabsch) over all positions that
/// are measured in all three directions, so it may be turned by any angle; the clock starts from
/// its present shift.
///
/// Throws Error (kInput) when the logs do not determine it: fewer than three rows, points on a
/// line, a marker that only translates, a part that changes nothing.
Registration Registered(const Experiment& e, const Wiring& wiring, const mjModel& m,
                        const std::vector<Trace>& traces);

/// The experiment with its registration estimated from its train logs as the model simulates them;
/// the same where nothing is to be estimated.
Experiment Registered(const Experiment& e, const ModelSpec& system);

}  // namespace continuum
