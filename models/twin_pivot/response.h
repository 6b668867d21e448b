#pragma once

#include <optional>

#include "models/statics/tip_response.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// How the tip of a solution of this case moves (statics::Respond): by fx, fy, fz, Mx, My, Mz and
/// by F1.. or, of cables driven by length, L1... load.reference and load.slide must be what the
/// case went on from, and load.tension what the winches found.
std::optional<statics::TipResponse> Respond(const Robot& robot, const Load& load, Method method,
                                            const Solution& solution);

}  // namespace continuum::twin_pivot
