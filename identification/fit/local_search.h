#pragma once

#include <cstdint>

#include "identification/fit/fit.h"
#include "identification/result/local_minima.h"

namespace continuum {

/// Whether dry friction may act in a model, of joints or cables, MuJoCo's own or ours.
bool HasDryFriction(const mjModel& m);

/// Looks around a fit for other minima of the cost, where dry friction acts in the model: there
/// it has many, and which of them a fit ends in depends on where it began.
///
/// Ends at once where slopes predict what small steps do and no parameter is at a bound: then no
/// other is near. With a start it goes on if the fit leaves more than noise and time step make, yet
/// not far more than noise. Else from the start of the fit (none if it is empty) another one goes
/// by secants. Then an evolution (identification/fit/evolution.h) looks for lower costs around the
/// best, in the directions that change the cost least; from the least another fit goes on. As long
/// as that helps much, again. Repeats with the same seed.
LocalMinima SearchAround(const Problem& problem, const Problem::Vector& start,
                         const std::vector<bool>& use, std::uint64_t seed,
                         const FitOptions& options, Fit& fit);

}  // namespace continuum
