#pragma once

#include "sim/experiment/experiment.h"
#include "sim/simulation/trace.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Fills trace.channel [channels x rows, SI] from trace.raw as this experiment's registration and
/// outputs measure it: marker, frame, delay, turn, scale, bias and drift, in this order.
void MeasureTrace(const Experiment& e, const Wiring& wiring, const Log& log, Trace& trace);

}  // namespace continuum
