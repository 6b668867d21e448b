#pragma once

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// Tests the residual of a complete fit against what no candidate covers: smooth random forces of
/// angle, speed and load, and constants and shifts in time of the channels.
///
/// extra: parameters of the problem beyond the experiment's own; inflation: of noise along any
/// direction; seed: of the random forces, whose directions are those at the model's own step.
/// of_step is not judged.
LackOfFit TestLackOfFit(const CandidateFitter& fitter, const Problem& problem,
                        const std::vector<Parameter>& extra, const Fitted& fitted,
                        const Sizes& sizes, double inflation, std::uint64_t seed);

}  // namespace continuum
