#pragma once

#include <string>
#include <vector>

#include "binding/effect_catalog.h"
#include "sim/experiment/experiment.h"

namespace continuum {

/// Why an effect makes no sense at some objects of a model: the model has it there already, or the
/// experiment fits it. Empty when it does make sense.
std::string ConflictAt(const EffectInfo& effect, Place place, const std::vector<std::string>& names,
                       const Experiment& experiment, const mjModel& m);

/// The same for a law beside the soft segments of a model.
std::string ConflictBesideSegments(const EffectInfo& effect, const Experiment& experiment,
                                   const mjModel& m);

}  // namespace continuum
