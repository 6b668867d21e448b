#pragma once

#include <vector>

#include "identification/candidates/hypothesis.h"

namespace continuum {

/// An effect of the measurement as candidates: on all outputs of a unit together, on those of each
/// sensor, on each alone (late ones also on all of any unit), or on the clock. wanted.where may
/// choose outputs or sensors by a glob. None where no output fits.
std::vector<Hypothesis> MeasureCandidates(const EffectInfo& effect, const Candidate& wanted,
                                          const Experiment& experiment, const ModelSpec& system,
                                          const Sizes& sizes);

}  // namespace continuum
