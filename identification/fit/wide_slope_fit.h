#pragma once

#include "identification/fit/fit.h"

namespace continuum {

/// FitParameters, and out of the valley where that ends. Machines that stick, slip and hit stops
/// make a cost of many narrow valleys, which slopes over a fifth of a parameter's size do not see:
/// where one step along those lowers the cost, the fit goes on with them and then anew, as it
/// began. The smooth path has no such valleys. Throws Error as FitParameters does.
Fit FitFar(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use,
           const FitOptions& options = {});

}  // namespace continuum
