#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace continuum {

/// How well the logs determine the parameters of a fit: standard errors, 95 % intervals and
/// correlations. How they are computed: identification/statistics/uncertainty.h.
struct Uncertainty {
  Eigen::VectorXd standard_error;  ///< [parameter] in its unit; NaN: not known
  Eigen::VectorXd lower, upper;    ///< [parameter] 95 % interval, within the bounds
  Eigen::VectorXd step = {};  ///< what a fine time step would add to the value; empty: not known
  Eigen::VectorXd by_numbers = {};  ///< what lengths and masses that are a little off may add to
                                    ///< the value (standard deviation); empty: not known
  Eigen::MatrixXd correlation;      ///< [parameters × parameters]
  Eigen::MatrixXd information;  ///< H [parameters × parameters]; zero for parameters at a bound
  std::vector<bool> at_bound;
  std::string lacks = {};  ///< in words, what the user did not wait for; empty: nothing

  /// Whether more is known than the values and at_bound.
  bool known() const { return !standard_error.hasNaN(); }
};

}  // namespace continuum
