#pragma once

#include <optional>

#include "models/statics/tip_response.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// How the module's tip moves at a solution of the forward model (statics::Respond), by fx, fy, fz,
/// which act at the end of the mount, and by p1, p2, p3.
std::optional<statics::TipResponse> Respond(const Module& module, const Method& method,
                                            const Case& row, const Solution& solution);

}  // namespace continuum::stiff_flop
