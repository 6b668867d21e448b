#pragma once

#include <optional>

#include "models/statics/tip_response.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// How the tip of a solution of this case moves (statics::Respond): by fx, fy, fz and by T1.. or,
/// of tendons driven by length, L1..., where loads.tension must be what the winches found.
std::optional<statics::TipResponse> Respond(const Robot& robot, const Loads& loads, Method method,
                                            const Solution& solution);

}  // namespace continuum::tdcr
