#pragma once

#include <vector>

#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// The equilibria of a case that a search finds (statics::FindRoots), stable or not, by rising
/// energy. `known`, the case's own solution when it has one, is among them and keeps its branch;
/// the others have the branch `other`. Every contact has slid from load.reference, as if each shape
/// had been pulled to directly.
std::vector<Solution> Equilibria(const Robot& robot, const Load& load, Method method,
                                 const Solution& known);

}  // namespace continuum::twin_pivot
