#pragma once

#include <optional>

#include "identification/problem/problem.h"

namespace continuum {

/// By how much runs under different conditions differ beyond what the model says of them [pooled
/// unit]: the RMS of
///
///   (r_a − r_b)/√2
///
/// over all pairs of logs of one trial under two conditions, with the same rows; r: residuals
/// [log]. What the model gets wrong in both alike cancels, so that a cause that acts in one of them
/// shows. Nothing without such pairs.
std::optional<double> ConditionContrast(const Problem& problem,
                                        const std::vector<Problem::Vector>& residuals);

}  // namespace continuum
