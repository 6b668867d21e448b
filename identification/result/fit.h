#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace continuum {

/// The outcome of a least-squares fit: the parameters, the cost there and how it ended.
struct Fit {
  Eigen::VectorXd x;  ///< [parameter] in its unit
  double cost = 0;    ///< ½ Σ r² over the logs of the fit
  int iterations = 0;
  std::size_t evaluations = 0;  ///< simulated logs
  double seconds = 0;           ///< wall clock
  bool converged = false;
  bool anew = false;  ///< begun anew from where the equations of motion hold best (FitByEquations)
  bool over_pieces = false;  ///< of the logs, as nothing follows them as a whole
  bool smooth = false;       ///< slopes predict what small steps do around it (HasRipples)
  std::string message;
  std::vector<double> trace;  ///< cost at the start and after each iteration

  /// By how much the last step that was taken lowered the cost; 0: none of the last three was.
  double LastGain() const;
};

}  // namespace continuum
