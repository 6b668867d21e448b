#pragma once

#include "models/statics/reach.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// The least pressures [Pa] of the forward model that bring ends of modules to a target
/// (statics::Reach), from those of `row`.
statics::Reached Reach(const ModuleSeries& series, const Method& method, const Case& row,
                       const statics::Target& target);

}  // namespace continuum::stiff_flop
