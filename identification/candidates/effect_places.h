#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/effect_catalog.h"
#include "sim/experiment/experiment.h"

namespace continuum {

/// Names of the objects of a model, among those that match a glob, where an effect makes sense.
std::vector<std::string> PlacesFor(const mjModel& m, const EffectInfo& effect, Place place,
                                   const std::string& glob, const Experiment& experiment);

/// Names as the text of a target or key that matches each of them.
std::string Globs(const std::vector<std::string>& names);

/// "joint q", "joints a, b", "world"; of more than six the number.
std::string InWords(Place place, const std::vector<std::string>& names);

}  // namespace continuum
