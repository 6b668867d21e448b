#pragma once

#include <vector>

#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// The equilibria of a case that a search finds (statics::FindRoots), stable or not, by rising
/// energy. `known`, the case's own solution when it has one, is among them and keeps its branch;
/// the others have the branch `other`. Contacts with kAsItSlides are searched without friction and
/// then slide from loads.from to where they hold.
std::vector<Solution> Equilibria(const Robot& robot, const Loads& loads, Method method,
                                 const Solution& known);

}  // namespace continuum::tdcr
