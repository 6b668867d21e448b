#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/fit/fit.h"
#include "identification/result/multi_start.h"

namespace continuum {

/// Fits from x, then from random points within the bounds, in equal ratios where these span more
/// than a factor of ten. The first is fitted alone, then eight at a time. Those that cannot come
/// near the best of those before them give up.
///
/// Repeats exactly for a seed. Throws Error as FitParameters, and when every start diverges.
MultiStart FitFromMany(const Problem& problem, const Problem::Vector& x,
                       const std::vector<bool>& use, int starts, std::uint64_t seed,
                       const FitOptions& options = {});

}  // namespace continuum
