#pragma once

#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Train logs that are enough for a first look at every candidate: evenly over all of them, and
/// thousands of rows, not tens of thousands.
std::vector<bool> LogsForALook(const Experiment& experiment);

}  // namespace continuum
