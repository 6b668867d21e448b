#pragma once

#include <cstdint>

#include "identification/fit/fit.h"

namespace continuum {

struct SwarmFitOptions {
  int particles = 20, iterations = 40;
  std::uint64_t seed = 1;
  double soft = 0;  ///< as of FitOptions
  ProgressCallback progress = {};
};

/// Particle swarm optimisation within the bounds, a baseline without derivatives: constriction
/// factor, each particle drawn to its own best and to that of all (clerc2002). Begins at the start
/// and at random points. Throws Error for parameters without finite bounds.
Fit FitBySwarm(const Problem& problem, const std::vector<bool>& use,
               const SwarmFitOptions& options = {});

}  // namespace continuum
