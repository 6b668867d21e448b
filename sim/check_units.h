#pragma once

#include "sim/experiment.h"
#include "sim/system.h"

namespace continuum {

/// Throws Error (file, line, key) when an input or an output has a unit of another dimension than
/// the number of the model that its column stands for. Counts (1, %, step) may stand for anything;
/// so may what passes through a gain, a gear or an output's scale.
void CheckUnits(const Experiment& experiment, const mjModel& model);

}  // namespace continuum
