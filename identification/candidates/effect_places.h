#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/effect_catalog.h"
#include "sim/experiment/experiment.h"

namespace continuum {

/// Names of the objects of a model, among those that match one of some globs, where an
/// effect makes sense.
std::vector<std::string> PlacesFor(const mjModel& m, const EffectInfo& effect, Place place,
                                   const std::string& globs, const Experiment& experiment);

/// Names of the objects of a model at a place that match one of some globs, in its order.
std::vector<std::string> NamesLike(const mjModel& m, Place place, const std::string& globs);

/// The text of a target or key that matches each of some names.
std::string GlobsOf(const std::vector<std::string>& names);

/// A place for people: "joint q", "joints a, b", "world". Of more than six objects it has the
/// number.
std::string PlaceText(Place place, const std::vector<std::string>& names);

}  // namespace continuum
