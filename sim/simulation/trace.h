#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Where a trial begins; empty: as the experiment says.
struct InitialState {
  std::vector<double> qpos, qvel;
  std::vector<double> memory = {};  ///< MemoryOf; empty: settled under the first inputs
};

/// What the simulation says about the channels of an experiment, at the rows of one log.
struct Trace {
  using Raw = std::vector<std::vector<std::vector<double>>>;
  std::vector<std::vector<double>> channel;  ///< [channel][row] SI, as it would be measured
  bool diverged = false;
  double diverged_at = 0;  ///< [s]
  /// [output][component][row] of whole sensors, before they are measured.
  Raw raw = {};
  /// [output][element][row] axes (row by row) in which a marker's offset is given; of positions
  /// only, and only where the experiment's registration has a marker.
  Raw axes = {};
  std::string why = {};  ///< it ended before the last row, where that is more than divergence

  std::string Failure() const;
};

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
