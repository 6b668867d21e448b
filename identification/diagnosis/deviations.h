#pragma once

#include <string>
#include <vector>

#include "sim/simulation/simulate.h"

namespace continuum {

/// Where and how the simulation differs from the measurement, in words. Of an orientation the
/// channel is the quaternion's that a turn about the axis shows most in.
struct Deviation {
  std::string log, channel, when, what;
};

/// The six largest deviations, in units of what the channels move; one for each channel of a log.
/// simulated: [log].
std::vector<Deviation> FindDeviations(const Experiment& experiment,
                                      const std::vector<Trace>& simulated);

}  // namespace continuum
