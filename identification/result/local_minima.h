#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "identification/result/free_parameter.h"
#include "identification/result/uncertainty.h"

namespace continuum {

/// Where a fit from beside the best one ended.
struct LocalMinimum {
  Eigen::VectorXd x;  ///< [parameter]
  double cost = 0;
};

/// Minima of the cost around a fit; that of the fit is left out.
struct LocalMinima {
  std::vector<LocalMinimum> found;

  /// What those say against the intervals of the fit (at x) that fit as well, within a hundredth of
  /// its cost, and lie outside of them: "several minima: S 0.443 … 0.643, v_d 0.318 … 0.464 fit as
  /// well within 1 %, …". Empty: nothing.
  std::string Doubts(const Eigen::VectorXd& x, double cost, const Uncertainty& uncertainty,
                     const std::vector<FreeParameter>& parameters) const;
};

}  // namespace continuum
