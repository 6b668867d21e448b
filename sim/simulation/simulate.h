#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Where a trial begins; empty: as the experiment says.
struct InitialState {
  std::vector<double> qpos, qvel;
  std::vector<double> memory = {};  ///< MemoryOf; empty: settled under the first inputs
};

/// What a machine remembers beside positions and speeds: activations, the past of its delays,
/// states of effects, its clock.
std::vector<double> MemoryOf(const mjModel& m, const mjData& d);

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

/// Names of an experiment resolved in a model. Throws Error for unknown actuators and sensors.
struct Wiring {
  struct Source {
    Output::Kind kind;
    int address;    ///< of the first number, in sensordata or actuator_force
    int size;       ///< numbers recorded: 1, or the whole sensor
    int component;  ///< of the channel among them
    /// What a registration does to it: nothing; R p + T; R v; R q.
    enum class Seen { kAsIs, kPoint, kVector, kTurn } seen = Seen::kAsIs;
    int sensor = -1;
  };
  std::vector<int> actuator;   ///< of each input
  std::vector<Source> output;  ///< of each output
  std::vector<bool> gated;     ///< inputs with an enable column
  bool marked = false;         ///< whether positions are those of markers

  Wiring(const Experiment& e, const mjModel& m);
};

/// Hours of computing for the smallest model; and an int counts them.
inline constexpr double kMostSteps = 1e9;

/// Throws Error when a log has more steps than anybody can wait for (times in a wrong unit).
void CheckLength(const Log& log, double timestep);

/// Runs one log through a machine (whose model is changed on the way): inputs held between rows or
/// linear, a row active at its own time (the crossing step is shortened), channels those of the
/// state at the row's time.
///
/// A simulation that diverges ends there: diverged is set, the rest of the channels is NaN.
Trace Simulate(ModelAndData& machine, const Experiment& e, const Log& log,
               const InitialState& initial = {}, const Hooks& hooks = {});

/// The channels anew from raw, as this experiment's registration and outputs measure them.
void MeasureTrace(const Experiment& e, const Wiring& wiring, const Log& log, Trace& trace);

/// The state in which the experiment's start, and the log's own, leaves a log's trial: qpos0 at
/// rest, the equilibrium, what joint sensors measure in the first row, or (estimate) also their
/// slope there. Throws Error for joints that the log's start names and that are no hinge or slide.
InitialState StartOf(ModelAndData& machine, const Experiment& e, const Log& log);

/// The state at a row as it was measured: positions of the row, speeds those of a joint velocity's
/// output, else the slope of a line through the row and its next two neighbours to each side.
/// None where some joint is not measured there, or is no hinge or slide.
std::optional<InitialState> StateAt(const mjModel& m, const Experiment& e, const Log& log,
                                    std::size_t row);

/// Static equilibrium under the first inputs, without friction, lags settled. Throws Error (kJob)
/// when there is none near qpos0.
InitialState Equilibrium(ModelAndData& machine, const Experiment& e, const Log& log);

}  // namespace continuum
