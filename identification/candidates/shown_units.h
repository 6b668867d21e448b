#pragma once

#include <map>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/effect_catalog.h"
#include "sim/experiment/experiment.h"

namespace continuum {

/// The unit in which each parameter of an effect at some objects is shown, by its name; empty for
/// pure numbers.
///
/// What its card says, with three exceptions: on slide joints and tendons the unit of a translation
/// ("N" for "N*m"), "output" as the experiment records it, "input" in SI as the actuator gets it.
std::map<std::string, std::string> ShownUnits(const EffectInfo& effect, Place place,
                                              const std::vector<std::string>& objects,
                                              const Experiment& experiment, const mjModel& m);

}  // namespace continuum
