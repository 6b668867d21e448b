#pragma once

#include <vector>

namespace continuum {

/// Solves A x = b by Gaussian elimination with row exchanges. A [n · n] is used up, x replaces b.
void SolveLinear(std::vector<double>& A, std::vector<double>& b);

}  // namespace continuum
