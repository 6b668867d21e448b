#pragma once

#include <cstdint>

#include "identification/fit/swarm_fit.h"
#include "sim/io/progress.h"

namespace continuum {

struct RegressorOptions {
  double cutoff = 0;  ///< of the low-pass [Hz]; 0: 50 Hz, or a fifth of the sampling rate
  SwarmConstants swarm = SwarmFitOptions{}.swarm;
  std::uint64_t seed = 1;
  ProgressCallback progress = {};
};

}  // namespace continuum
