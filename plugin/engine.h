#pragma once

#include <functional>
#include <memory>
#include <string>

#include <mujoco/mujoco.h>

#include "binding/bound_law.h"

namespace continuum {

/// Registers every law that runs in the engine as the MuJoCo plugin "continuum.<name>". Throws
/// Error when the process cannot use it (another release, a second libmujoco).
void RegisterEffects();

/// The law of a plugin instance in d; null where it is none of ours or d was never init-ed.
BoundLaw* FindBound(const mjModel& m, const mjData& d, int instance);

/// The law of a plugin instance in d, to read or set its parameters (order of its card). Throws
/// Error when the model has no instance of this name or it is not one of ours.
BoundLaw& BoundOf(const mjModel& m, const mjData& d, int instance);

/// Sets the parameters of an instance for this d, and the model constants that depend on them.
void SetParameters(mjModel& m, mjData& d, int instance, const std::vector<double>& parameters);

/// Brings the lags among the effects to where constant controls, those of d, have always held them.
void SettleEffects(const mjModel& m, mjData& d);

}  // namespace continuum
