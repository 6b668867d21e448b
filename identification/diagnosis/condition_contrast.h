#pragma once

#include "identification/problem/problem.h"

namespace continuum {

/// How far runs under different conditions are apart beyond what the model says of them [pooled
/// unit]: the RMS of
///
///   (r_a − r_b)/√2
///
/// over all pairs of logs of one trial under two conditions, with the same rows; r: residuals. What
/// the model gets wrong in both alike cancels, so that a cause that acts in one of them shows. NaN
/// without such pairs.
double BetweenConditions(const Problem& problem, const std::vector<Problem::Vector>& residuals);

}  // namespace continuum
