#pragma once

#include <string>

#include "identification/problem/problem.h"

namespace continuum {

/// What keeps the smooth path from following a problem's model at its start: dry friction, contacts
/// or limits that act, delays, discrete states. Empty: nothing does. Simulates every log
/// once.
std::string SmoothObstacle(const Problem& problem);

/// Why the smooth path would gain nothing: it begins anew at every row where an input jumps or
/// bends. Empty: such rows are few.
std::string SmoothCost(const Problem& problem);

}  // namespace continuum
