#pragma once

#include "sim/model/change.h"

namespace continuum {

/// Throws Error (target, attribute, range, unit) for a value that no machine can have: a negative
/// mass, inertia, damping, dry friction, density, delay or lag, a time step that is not positive,
/// a parameter of a native effect beyond what its card allows, and any number above 10¹² in size.
/// Ends of ranges may be as large as they like: they then say that there is no limit. A factor of
/// what is never negative must not be negative.
void RequirePossible(const Change& change);

}  // namespace continuum
