#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// The parts of MuJoCo's state (mjtState) that a machine remembers beside positions and speeds:
/// activations, the past of its delays, states of effects, its clock.
inline constexpr int kMemory = mjSTATE_TIME | mjSTATE_ACT | mjSTATE_HISTORY | mjSTATE_PLUGIN;

/// Parts of the state of a simulation as mj_getState gives them; to be put back by mj_setState.
std::vector<double> StateOf(const mjModel& m, const mjData& d, int parts);
/// InitialState::memory as it is now.
inline std::vector<double> MemoryOf(const mjModel& m, const mjData& d) {
  return StateOf(m, d, kMemory);
}

/// The state in which the experiment's start, and the log's own, leaves a log's trial: qpos0 at
/// rest, the equilibrium, what joint sensors measure in the first row, or (estimate) also their
/// slope there. Throws Error for joints that the log's start names and that are no hinge or slide.
InitialState StartOf(ModelAndData& machine, const Experiment& e, const Log& log);

/// The state at a row as it was measured: positions of the row, speeds those of a joint velocity's
/// output, else the slope of a line through the row and its next two neighbours to each side.
/// None where some joint is not measured there, or is no hinge or slide.
std::optional<InitialState> StateAt(const mjModel& m, const Experiment& e, const Log& log,
                                    std::size_t row);

}  // namespace continuum
