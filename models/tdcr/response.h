#pragma once

#include <optional>

#include "models/statics/tip_response.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// Where the contacts of a solution stand, for cases that go on from it.
Contacts LeftBy(const Robot& robot, const Loads& loads, Method method, const Solution& solution);

/// How the tip of a solution of this case moves (statics::Respond): by fx, fy, fz and by T1.. or,
/// of tendons driven by length, L1... loads.from must be what the case went on from, and
/// loads.tension what the winches found.
std::optional<statics::TipResponse> Respond(const Robot& robot, const Loads& loads, Method method,
                                            const Solution& solution);

}  // namespace continuum::tdcr
