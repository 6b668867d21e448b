#pragma once

#include <cstddef>
#include <string>

#include "identification/result/uncertainty.h"

namespace continuum {

/// The outcome of least squares on the inverse dynamics along the measured motion.
struct Regression {
  Eigen::VectorXd x;  ///< [parameter] in its unit
  Uncertainty uncertainty;
  /// Relative force error 100 |τ_model − τ| / |τ| [%] over all joints, of the train and of the
  /// other logs.
  double train = 0, validate = 0;
  std::size_t rows = 0;  ///< equations, one for each joint and row
  double seconds = 0;    ///< wall clock
  std::string how;       ///< which parameters were found in which way, one line
  int iterations = 0;    ///< of the particle swarm; 0: there was none
};

}  // namespace continuum
