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

/// The chosen parts (mjtState) of a simulation's state, as mj_getState orders them. mj_setState
/// puts them back.
std::vector<double> StateOf(const mjModel& m, const mjData& d, int parts);
/// The part of the state that is neither position nor velocity: InitialState::memory.
inline std::vector<double> MemoryOf(const mjModel& m, const mjData& d) {
  return StateOf(m, d, kMemory);
}

/// The initial state of a log as the experiment's key `start` defines it: qpos0 at rest, the static
/// equilibrium, what joint sensors measure in the first row, or (estimate) also the slope of the
/// measured positions there. The log's own key `start` replaces single joints. Motors of elastic
/// gears follow their joints, but in equilibrium. Throws Error for
/// joints there that are neither hinge nor slide.
InitialState StartOf(ModelAndData& machine, const Experiment& e, const Log& log);

/// The measured state of all joints at a row, or nothing where a joint is not measured or is
/// neither hinge nor slide. Motors of elastic gears follow their joints. Velocities are measured
/// ones, else slopes of a least-squares line through the row and its next two neighbours on either
/// side.
std::optional<InitialState> StateAt(const mjModel& m, const Experiment& e, const Log& log,
                                    std::size_t row);

}  // namespace continuum
