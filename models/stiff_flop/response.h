#pragma once

#include <optional>

#include "models/statics/tip_response.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// How the tip and the ends of all modules move at a solution of the forward model
/// (statics::Respond), by fx, fy, fz, which act at the end of the last mount, and by p1, p2, ..
std::optional<statics::TipResponse> Respond(const ModuleSeries& series, const Method& method,
                                            const Case& row, const Solution& solution);

}  // namespace continuum::stiff_flop
