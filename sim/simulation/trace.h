#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// The state in which the simulation of a log begins. Empty: the one that the experiment asks for.
struct InitialState {
  std::vector<double> qpos, qvel;   ///< [nq], [nv] as in mjData
  std::vector<double> memory = {};  ///< MemoryOf; empty: steady state under the first inputs
};

/// The simulated counterpart of a log: a value for every channel and row of the log.
struct Trace {
  using Raw = std::vector<std::vector<std::vector<double>>>;
  /// [channels x rows] in SI, as the experiment would measure it: with registration, delay, bias.
  std::vector<std::vector<double>> channel;
  bool diverged = false;
  double diverged_at = 0;  ///< [s]
  /// [outputs x components x rows] of whole sensors in the frame of the model.
  Raw raw = {};
  /// [outputs x 9 x rows] rotation matrices (row by row) of the objects to which markers are fixed.
  /// Of positions only, and only where the experiment's registration has a marker.
  Raw axes = {};
  std::string why = {};  ///< reason of an end before the last row, other than divergence

  /// One sentence: why the simulation ended before the last row.
  std::string Failure() const;
};

/// Functions of the caller that a simulation calls on its way.
struct Hooks {
  /// At every row, with the state that the row sees and all that follows from it; must not write.
  std::function<void(const mjModel&, mjData&, std::size_t row)> row = {};
  /// Before every step; may write qfrc_applied.
  std::function<void(const mjModel&, mjData&)> step = {};
  /// After every step, with the state after it and the forces that made it; must not write.
  std::function<void(const mjModel&, mjData&)> stepped = {};

  /// Hooks that end the simulation with an Error (kJob) when the user asks to stop.
  static Hooks Stoppable();
};

}  // namespace continuum
