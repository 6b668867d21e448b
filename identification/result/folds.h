#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace continuum {

/// Logs that cross-validation leaves out together.
struct Fold {
  std::string name;            ///< "condition kp400"
  std::vector<bool> left_out;  ///< [log]
};

/// A model refitted without each fold and scored on it.
struct FoldScores {
  std::vector<double> error;       ///< [fold] pooled RMS on what was left out
  std::vector<Eigen::VectorXd> x;  ///< [fold] the refitted parameters
};

}  // namespace continuum
