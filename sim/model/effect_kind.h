#pragma once

#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Whether an effect of the model knows the tension of cables along their way, and colours them by
/// it (PathLaw).
bool HasPathLaw(const mjModel& m);

/// Whether an effect of the model stands for a soft segment with its chambers, and colours them by
/// their pressure (SegmentLaw with Chambers).
bool HasChamberLaw(const mjModel& m);

/// The parameters, in the order of the card, at which the path law of a plugin instance has no
/// friction; empty when the instance is none.
std::vector<double> FrictionlessPath(const mjModel& m, int instance);

}  // namespace continuum
