#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// Computes the interval of the gain by drawing whole trials anew; folds where trials are too few.
/// {0, 0} without a chosen candidate.
GainInterval BootstrapGain(const Problem& null, const Diagnosis& diagnosis, std::uint64_t seed);

}  // namespace continuum
