#pragma once

#include <string>

#include "identification/problem/problem.h"

namespace continuum {

/// What keeps the smooth path from following a problem's model at its start: native dry friction,
/// contacts and limits that act, friction of cables that is no bristle, delays, discrete states.
/// Empty: nothing does. Simulates every log once.
std::string SmoothObstacle(const Problem& problem);

/// Why the smooth path would gain nothing: it begins anew at every row where an input jumps or
/// bends, and dry friction that sticks may take it more evaluations than there are steps. Empty: it
/// gains.
std::string SmoothCost(const Problem& problem);

}  // namespace continuum
