#pragma once

#include <string>
#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// Logs that cross-validation leaves out together.
struct Fold {
  std::string name;            ///< "condition kp400"
  std::vector<bool> left_out;  ///< [log]
};
/// One fold per trial, condition or log, as the experiment asks; groups that hold every log are
/// none.
std::vector<Fold> FoldsOf(const Experiment& experiment);

/// A model refitted without each fold and scored on it.
struct FoldScores {
  std::vector<double> error;       ///< pooled RMS on what was left out
  std::vector<Problem::Vector> x;  ///< the refitted parameters
};
/// x, r, J: an optimum, and residuals and Jacobian of every log there. Each fold is refitted by
/// Gauss-Newton from x and scored by a free simulation of the logs it left out.
FoldScores CrossValidate(const Problem& problem, const Problem::Vector& x,
                         const std::vector<Problem::Vector>& r,
                         const std::vector<Problem::Matrix>& J, const std::vector<Fold>& folds);

}  // namespace continuum
