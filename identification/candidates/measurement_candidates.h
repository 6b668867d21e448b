#pragma once

#include <vector>

#include "binding/effect_catalog.h"
#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// The hypothesis that an effect of the measurement acts on some outputs alike: nothing of the
/// model changes. names: of outputs by their first column, or of the sensors that are turned; none:
/// the clock. Throws Error where one value has no meaning for all of them, as their units differ.
Hypothesis MeasurementCandidate(const EffectInfo& effect, const std::vector<std::string>& names,
                                const Experiment& experiment, const ModelSpec& system,
                                const Sizes& sizes);

/// Whether an effect of the measurement is one of the clock.
bool IsOfClock(const EffectInfo& effect);

/// Names of the outputs on which an effect of the measurement may act, among those whose sensor or
/// column matches one of some globs.
std::vector<std::string> OutputsFor(const EffectInfo& effect, const std::string& globs,
                                    const Experiment& experiment, const mjModel& m);

/// Sets of these that one cause may act on alike: all of a unit, those of each sensor among them,
/// each alone. Late ones also all of any unit together, as the input may be late.
std::vector<std::vector<std::string>> OutputsTogether(const EffectInfo& effect,
                                                      const std::string& globs,
                                                      const Experiment& experiment,
                                                      const mjModel& m);

}  // namespace continuum
