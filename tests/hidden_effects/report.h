#pragma once

#include <string>
#include <vector>

#include "hidden_effects/tally.h"

namespace continuum::hidden {

/// All tables of a run, as text.
std::string Report(const std::vector<Outcome>& outcomes);

}  // namespace continuum::hidden
