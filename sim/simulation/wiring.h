#pragma once

#include <vector>

#include <mujoco/mujoco.h>

#include "sim/experiment/experiment.h"

namespace continuum {

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

}  // namespace continuum
