#pragma once

#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Train logs that are enough for a first look at every candidate: one of each trial, evenly over
/// all of them, with hardly more than a thousand rows and not far too many time steps [s] to
/// simulate; never fewer than two of several.
std::vector<bool> LogsForALook(const Experiment& experiment, double step);

}  // namespace continuum
