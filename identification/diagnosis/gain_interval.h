#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// 95 % interval of the share of the held-out error removed, by drawing whole trials anew; the
/// folds where trials are too few. {0, 0} without a chosen candidate.
struct GainInterval {
  double low = 0, high = 0;
};
GainInterval BootstrapGain(const Problem& null, const Diagnosis& diagnosis, std::uint64_t seed);

}  // namespace continuum
