#pragma once

#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Train logs that are enough for a first look at every candidate: one of each trial, evenly over
/// all of them, and hardly more than a thousand rows; never fewer than two of several.
std::vector<bool> LogsForALook(const Experiment& experiment);

}  // namespace continuum
