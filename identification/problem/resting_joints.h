#pragma once

#include <vector>

#include "sim/simulation/simulate.h"

namespace continuum {

/// Those of the joints (hinges and slides) that nothing measures and nothing moves in a log, such
/// as those across the plane in which an arm bends: no output depends on their position or speed to
/// first order, at the start of the log and where a simulation from there ends, and they stay where
/// they begin in it. The log says nothing of how they begin. The simulation is only made where a
/// joint may be one of them.
std::vector<int> RestingJoints(ModelAndData& machine, const Experiment& e, const Log& log,
                               const InitialState& start, std::vector<int> joints);

}  // namespace continuum
