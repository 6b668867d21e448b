#pragma once

#include <vector>

#include "identification/result/free_parameter.h"
#include "sim/simulation/simulate.h"

namespace continuum {

/// Where the trials begin when nobody says it (start: estimate): position and speed of every hinge
/// and slide joint at the first row of each log, two parameters each, but for joints that linear
/// equalities tie to others (sim/model/joint_equalities.h) and those that nothing measures and
/// nothing moves (resting_joints.h), which begin at rest. They begin at what the log
/// measures there (StartOf), and stay within what it does at all. Empty for other starts. Throws
/// Error for joints of other kinds.
std::vector<FreeParameter> StartParameters(const Experiment& experiment, const ModelSpec& system);

/// Moves a state to where such parameters are.
void SetInitialState(const mjModel& m, const Change& change, InitialState& state);
/// Moves the joints that are tied to others to where these are.
void SetTiedJoints(ModelAndData& machine, InitialState& state);

}  // namespace continuum
