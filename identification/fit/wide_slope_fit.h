#pragma once

#include "identification/fit/fit.h"

namespace continuum {

/// Fits as FitParameters does, then tries to leave the local minimum where that ends.
///
/// Machines that stick, slip and hit stops make a cost of many narrow local minima, which slopes
/// over a fifth of a parameter's scale do not see. Where one step along those lowers the cost, the
/// fit goes on with them and then again with its own. The smooth path has no such minima. Throws
/// Error as FitParameters does.
Fit FitWithWideSlopes(const Problem& problem, const Problem::Vector& x,
                      const std::vector<bool>& use, const FitOptions& options = {});

}  // namespace continuum
