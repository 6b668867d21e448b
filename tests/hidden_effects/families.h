#pragma once

#include <string>
#include <vector>

namespace continuum::hidden {

/// Effects that are laws of one thing, the plainest first: dry friction, lateness, mass. An effect
/// of no such family is alone in its own.
std::vector<std::string> FamilyOf(const std::string& effect);

/// Whether an effect is a law of dry friction.
bool IsDryFriction(const std::string& effect);

}  // namespace continuum::hidden
