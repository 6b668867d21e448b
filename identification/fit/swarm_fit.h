#pragma once

#include <cstdint>
#include <filesystem>

#include "identification/fit/fit.h"
#include "sim/numerics/particle_swarm.h"

namespace continuum {

/// Those of an experiment's key `swarm`, as the snake arm's paper names them (Table 2); what it
/// does not give is the default. Throws Error with file:line and key.
SwarmConstants ReadSwarm(const std::filesystem::path& experiment);

struct SwarmFitOptions {
  SwarmConstants swarm{.to_own = 1.49618, .to_all = 1.49618};
  std::uint64_t seed = 1;
  double soft = 0;  ///< as of FitOptions
  ProgressCallback progress = {};
};

/// Particle swarm optimisation within the bounds, a baseline without derivatives: each particle is
/// drawn to its own best and to that of all (ParticleSwarm). Begins at the start
/// and at random points. Throws Error for parameters without finite bounds.
Fit FitBySwarm(const Problem& problem, const std::vector<bool>& use,
               const SwarmFitOptions& options = {});

}  // namespace continuum
