#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace continuum {

/// The outcome of multiple shooting: where the fit of whole logs begins after one of their
/// segments.
struct ShootingSegments {
  Eigen::VectorXd x;             ///< [parameter] in its unit
  double before = 0, after = 0;  ///< ½ Σ r² of the whole logs, at the start and at x
  double seconds = 0;            ///< wall clock
  std::size_t evaluations = 0;   ///< simulated logs
};

}  // namespace continuum
