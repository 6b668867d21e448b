#pragma once

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Throws Error (file, line, key) when an output has a unit of another dimension than the sensor
/// that its column stands for. Counts (1, %, step) may stand for anything; so may what passes
/// through a scale, and the controls and forces of actuators, whose gains have any unit.
void CheckUnits(const Experiment& experiment, const mjModel& model);

}  // namespace continuum
