#pragma once

#include <cstddef>
#include <vector>

namespace continuum {

/// The error of predictions over a few rows, each from the state measured at its first row.
struct PredictionError {
  std::size_t rows;                     ///< length of a prediction
  double seconds;                       ///< the same, in the median
  std::vector<double> train, validate;  ///< [channel] root mean square error [SI]; NaN: none
};

}  // namespace continuum
