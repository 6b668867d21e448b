#pragma once

#include <span>
#include <string>

#include <mujoco/mujoco.h>

#include "binding/cable.h"
#include "binding/config.h"

namespace continuum {

/// What of the routes of cables may not be meant, or is not counted: a sentence for the user;
/// empty: nothing.
std::string DoubtsOf(const mjModel& m, const Config& config, std::span<const Cable> cables);

}  // namespace continuum
