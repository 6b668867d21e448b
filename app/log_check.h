#pragma once

#include <string>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Prints what the check of the logs warns of to stderr: its first lines, and channels without
/// variance in full. file: of the experiment, for the hint at `continuum check`.
void PrintLogCheck(const std::string& file, const Experiment& experiment);

/// The same, and what the model says of units, signs and columns that were taken for another.
void PrintLogCheck(const std::string& file, const Experiment& experiment, const ModelSpec& system);

}  // namespace continuum
