#pragma once

#include <string>
#include <vector>

#include "binding/effect_catalog.h"
#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// The hypothesis that an effect acts on some objects of a model, where the effect is an attribute
/// of MuJoCo. names: of the objects at the place. fitted: what a fit has made of the model.
Hypothesis EditCandidate(const EffectInfo& effect, Place place,
                         const std::vector<std::string>& names, const Experiment& experiment,
                         const ModelSpec& system, const std::vector<Change>& fitted, Sizes sizes);

/// The same where the effect is a plugin instance. A dry friction that contains Coulomb's takes the
/// place of the model's Coulomb friction on the same joints. option: of its choice.
Hypothesis PluginCandidate(const EffectInfo& effect, Place place,
                           const std::vector<std::string>& names, const ModelSpec& system,
                           const Sizes& sizes, int option);

/// The same for a law that the experiment writes as a formula. Its parameters are p1, p2, .. of the
/// instance.
Hypothesis FormulaCandidate(const EffectInfo& effect, const WrittenLaw& law, Place place,
                            const std::vector<std::string>& names, const ModelSpec& system);

/// Names of the plugin instances of soft segments that have all that an effect beside them takes
/// from them: the parameters without a null on its card.
std::vector<std::string> SegmentsFor(const mjModel& m, const EffectInfo& effect);

/// The same for a law beside a soft segment of the model, whose places, choices and geometry are
/// the segment's. names: of its plugin instance, which is one. Throws Error for several.
Hypothesis SegmentCandidate(const EffectInfo& effect, const std::vector<std::string>& names,
                            const ModelSpec& system, Sizes sizes);

}  // namespace continuum
