#pragma once

#include <set>
#include <string>

#include "identification/candidates/hypothesis.h"

namespace continuum {

/// The conditions of an experiment, all of which it can be trained on. Throws Error for fewer than
/// two, and where one has no train log. candidate: that asks for them, for messages.
std::set<std::string> TrainedConditions(const Experiment& experiment, const std::string& candidate);

/// Gives an effect values of its own under each condition.
void SplitByCondition(Hypothesis& hypothesis, const std::set<std::string>& conditions);

}  // namespace continuum
