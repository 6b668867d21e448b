#pragma once

#include <cstdint>

#include "identification/fit/fit.h"

namespace continuum {

/// Where a fit on the smooth path begins if dry friction acts: at the values of a fit by steps, of
/// its own search (SearchAround), as a fine time step would give them. A machine that sticks and
/// slips has many local minima; by steps these are found in a fraction of the time that CVODES
/// takes for its corners.
///
/// Of what is returned x, evaluations and seconds count. x is `start` where fits by steps diverge.
Fit FitBySteps(const Problem& smooth, const Problem::Vector& start, const std::vector<bool>& use,
               std::uint64_t seed, const FitOptions& options);

}  // namespace continuum
