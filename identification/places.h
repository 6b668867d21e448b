#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "identification/catalog.h"
#include "sim/experiment.h"

namespace continuum {

/// Names of the objects of a model, among those that match a glob, where an effect makes sense.
std::vector<std::string> PlacesFor(const mjModel& m, const EffectInfo& effect, Place place,
                                   const std::string& glob, const Experiment& experiment);

/// "joint q", "joints a, b", "world"; of more than six the number.
std::string InWords(Place place, const std::vector<std::string>& names);

}  // namespace continuum
