#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// What a run without measurements is asked for; names of options stand in its messages.
struct OpenLoopOptions {
  std::string model;  ///< MJCF file
  std::string input;  ///< CSV with `time` and a column per control; empty: all controls zero
  std::string keyframe = {};  ///< to begin at; without input its controls are held
  double every = 0;           ///< [s] between the rows that are written; 0: see PlanRun
  double until = 0;           ///< [s] end; 0: the last row of the input, or 10 s
  double timestep = 0;        ///< [s]; 0: that of the model
};

/// A run as an experiment without outputs, whose only log has every named actuator as an input.
struct OpenLoopRun {
  Experiment experiment;
  std::vector<bool> written;  ///< [row] whether it is to be written, or only read
};

/// Rows of the input, held between them, and rows to be written: every `every` seconds, else every
/// `period` seconds, else (0) at the rows of the input. m: the compiled model, with its time step.
/// Throws Error (kInput) for an input that does not fit the model, and for too many rows or steps.
OpenLoopRun PlanRun(const OpenLoopOptions& options, const mjModel& m, double period);

/// The state that a keyframe of the model gives, at time 0. Throws Error, listing the keyframes,
/// when there is none of this name.
InitialState KeyframeState(ModelAndData& machine, const std::string& name);

/// The header of a CSV with all sensors of a model: "time", then `name`, or `name[i]` of each
/// component where a sensor has several.
std::string SensorHeader(const mjModel& m);

}  // namespace continuum
