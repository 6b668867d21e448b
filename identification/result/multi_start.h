#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "identification/result/fit.h"

namespace continuum {

/// One start of several, and the cost at which its fit ended.
struct Start {
  Eigen::VectorXd x;  ///< [parameter] where it began
  double cost = 0;    ///< infinite where the simulation diverges at the start
};

/// A fit from several starts: the best, and how each of them ended.
struct MultiStart {
  Fit best;
  std::vector<Start> starts;  ///< in the order in which they were tried; the given one first

  /// How many ended within a share of the best cost.
  std::size_t Reached(double share = 1e-3) const;
  /// "3 of 5 starts end within 0.1 % of the best cost"
  std::string InWords() const;
};

}  // namespace continuum
