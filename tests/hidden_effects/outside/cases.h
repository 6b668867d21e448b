#pragma once

#include <vector>

#include "hidden_effects/suite.h"

namespace continuum::hidden {

/// The outside suite: six machines by equations of their own, whose masses and lengths are 1 % off
/// their models. quick: some 15 of about 110 cases, one of each kind.
std::vector<Case> OutsideCases(bool quick);

}  // namespace continuum::hidden
