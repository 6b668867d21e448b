#pragma once

#include <vector>

#include "identification/diagnosis/equation_error.h"

namespace continuum {

/// What each candidate explains of the missing force (CandidateResult::by_equation).
void CompareByForces(const EquationErrors& forces, std::vector<CandidateResult>& candidates);

}  // namespace continuum
