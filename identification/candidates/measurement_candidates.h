#pragma once

#include <vector>

#include "binding/effect_catalog.h"
#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// The hypotheses that an effect of the measurement acts on the outputs or on the clock. Outputs
/// are tried together by unit, together by sensor, and each alone; delays also on all outputs
/// together. wanted.where may choose outputs or sensors by a glob. Returns none where no output
/// fits.
std::vector<Hypothesis> MeasurementCandidates(const EffectInfo& effect, const Candidate& wanted,
                                              const Experiment& experiment, const ModelSpec& system,
                                              const Sizes& sizes);

}  // namespace continuum
