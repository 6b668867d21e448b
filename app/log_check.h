#pragma once

#include <string>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Prints what the check of the logs warns of to stderr: its first lines, and channels without
/// variance in full. file: of the experiment, for the hint at `continuum check`.
void PrintLogCheck(const std::string& file, const Experiment& experiment);

}  // namespace continuum
