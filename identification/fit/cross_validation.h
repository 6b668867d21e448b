#pragma once

#include <string>
#include <vector>

#include "identification/fit/fit.h"
#include "identification/result/folds.h"

namespace continuum {

/// One fold per trial, condition or log, as the experiment asks; groups that hold every log are
/// none.
std::vector<Fold> FoldsOf(const Experiment& experiment);

/// x, r, J: an optimum, and residuals and Jacobian of every log there. Each fold is refitted by
/// Gauss-Newton from x and scored by a free simulation of the logs it left out.
FoldScores CrossValidate(const Problem& problem, const Problem::Vector& x,
                         const std::vector<Problem::Vector>& r,
                         const std::vector<Problem::Matrix>& J, const std::vector<Fold>& folds);

}  // namespace continuum
