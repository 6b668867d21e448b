#pragma once

#include "sim/model/change.h"

namespace continuum {

/// Throws Error (target, attribute, range, unit) for a value that no machine can have: a negative
/// mass, inertia, damping, dry friction, density, delay or lag, a time step that is not positive.
void RequirePossible(const Change& change);

}  // namespace continuum
