#pragma once

#include "models/statics/reach.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// Linear systems of the search for one target, sections included: then it is given up.
/// A place that pressures of 60 kPa reach takes some 20 thousand, one far beyond 364 thousand.
constexpr long kMostOfReach = 600000;

/// The least pressures [Pa] of the forward model that bring ends of modules to a target
/// (statics::Reach), from those of `row`.
statics::Reached Reach(const ModuleSeries& series, const Method& method, const Case& row,
                       const statics::Target& target);

}  // namespace continuum::stiff_flop
