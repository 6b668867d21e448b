#pragma once

#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Whether an effect of the model drives a soft segment (SegmentLaw). Such effects colour chambers
/// by their pressure.
bool HasSegmentLaw(const mjModel& m);

/// The parameters, in the order of the card, at which the path law of a plugin instance has no
/// friction; empty when the instance is none.
std::vector<double> FrictionlessPath(const mjModel& m, int instance);

}  // namespace continuum
