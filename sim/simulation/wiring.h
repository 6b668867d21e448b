#pragma once

#include <vector>

#include <mujoco/mujoco.h>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Where the inputs and outputs of an experiment are in a model: indices instead of names. Throws
/// Error for actuators and sensors that the model lacks. An actuator with several controls is
/// written with the index of one, 'servo[1]'.
struct Wiring {
  /// Where an output is recorded.
  struct Source {
    Output::Kind kind;
    int address;    ///< of the first number, in sensordata, actuator_force or ctrl
    int size;       ///< how many numbers are recorded: 1, or those of the whole sensor
    int component;  ///< index of the channel among these numbers
    /// How a registration transforms it: not at all; R p + T; R v; R q.
    enum class Geometry { kNone, kPoint, kVector, kRotation } geometry = Geometry::kNone;
    int sensor = -1;  ///< id; −1: a number of an actuator
  };
  std::vector<int> actuator;   ///< [inputs] ids
  std::vector<int> control;    ///< [inputs] addresses in mjData::ctrl
  std::vector<Source> output;  ///< [outputs]
  std::vector<bool> gated;     ///< [inputs] whether there is an enable column
  bool marked = false;         ///< whether positions are those of markers, not of sensors

  Wiring(const Experiment& e, const mjModel& m);
};

}  // namespace continuum
