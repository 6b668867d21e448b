#pragma once

#include <string>
#include <string_view>

#include <mujoco/mujoco.h>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// The unit of a parameter of the model: what the card of its effect says, or what MuJoCo's
/// attribute has; on slide joints and tendons that of a translation ("N*s/m" for "N*m*s/rad"). "1"
/// for factors, and where the joints of one parameter differ.
std::string UnitOf(const ModelSpec& system, const Parameter& p);

/// A unit of what turns, on those joints or tendons (kind) whose names match: that of a translation
/// where they slide, "1" where they differ.
std::string UnitOn(const mjModel& m, const std::string& unit, std::string_view kind,
                   std::string_view globs);

}  // namespace continuum
