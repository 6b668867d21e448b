#pragma once

#include "binding/bound_law.h"

namespace continuum {

/// The law of a plugin instance, or null.
using LawFinder = BoundLaw* (*)(const mjModel& m, const mjData& d, int instance);

/// Registers the sensor plugin "continuum.wrench", which asks for the laws of a model.
void RegisterWrench(LawFinder law_of);

}  // namespace continuum
