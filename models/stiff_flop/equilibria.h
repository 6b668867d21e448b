#pragma once

#include <vector>

#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// The equilibria of a case of the forward model that a search finds (statics::FindRoots), stable
/// or not, by rising energy. `known`, the case's own solution when it has one, is among them and
/// keeps its branch; the others have the branch `other`.
std::vector<Solution> Equilibria(const ModuleSeries& series, const Method& method, const Case& row,
                                 const Solution& known);

}  // namespace continuum::stiff_flop
