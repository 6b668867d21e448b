#pragma once

#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// Whether the residuals at x are far over the noise and 0.3 of the measured motion or more: then a
/// swing may be out of step with the measured one, and a better fit be elsewhere.
bool IsOutOfStep(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use);

}  // namespace continuum
