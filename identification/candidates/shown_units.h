#pragma once

#include <map>
#include <string>

#include "identification/candidates/object_sets.h"

namespace continuum {

/// The unit in which each parameter of an effect at some objects is shown, by its name; empty for
/// pure numbers.
///
/// What its card says, with three exceptions: on slide joints and tendons the unit of a translation
/// ("N" for "N*m"), "output" as the experiment records it, "input" in SI as the actuator gets it.
std::map<std::string, std::string> ShownUnits(const EffectInfo& effect, const ObjectSet& objects,
                                              const CandidateContext& context);

}  // namespace continuum
