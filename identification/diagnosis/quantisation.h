#pragma once

#include "identification/diagnosis/screening.h"

namespace continuum {

/// The noise of values that are rounded to steps larger than their noise, in a diagnosis. x: the
/// fitted model, which is simulated only where some are.
class Quantisation {
 public:
  Quantisation(const Problem& problem, const Noise& noise, const Problem::Vector& x);

  bool any() const { return any_; }
  /// The noise with that of the rounded channels as a model moves between their steps.
  Noise Corrected() const;
  /// Rounding errors are neither normal nor stationary: how much more of them than of whitened
  /// noise the directions of the candidates take up, by draws; at least 1.
  double Inflation(const ProjectedResidual& residual,
                   const std::vector<std::vector<Probe>>& candidates, std::uint64_t seed) const;
  /// Draws of the noise of all channels, projected as the residual of a fit; one column each.
  Problem::Matrix Draws(const ProjectedResidual& residual, int count, std::uint64_t seed) const;

 private:
  std::vector<Problem::Matrix> Draw(Random64& random, bool all) const;

  const Problem* problem_;
  const Noise* noise_;
  std::vector<Trace> traces_;  // [log]
  bool any_ = false;
};

}  // namespace continuum
