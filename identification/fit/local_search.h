#pragma once

#include <cstdint>

#include "identification/fit/fit.h"
#include "identification/result/local_minima.h"

namespace continuum {

/// Looks around a fit for other minima of the cost, where dry friction acts in the model: there
/// it has many, and which of them a fit ends in depends on where it began.
///
/// Fits by secants begin where the fit did, where it ended, and a few beside that, where first
/// order says that the cost is higher by a tenth. One that ends lower takes its place, fitted to
/// the end. Repeats with the same seed.
LocalMinima SearchAround(const Problem& problem, const Problem::Vector& start,
                         const std::vector<bool>& use, std::uint64_t seed,
                         const FitOptions& options, Fit& fit);

}  // namespace continuum
