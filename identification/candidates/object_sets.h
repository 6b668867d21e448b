#pragma once

#include <string>
#include <vector>

#include "binding/effect_catalog.h"
#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// The model that candidates extend.
struct SearchBase {
  const ModelSpec* system;            ///< with the causes that have been found
  std::vector<Parameter> given = {};  ///< free parameters of these
  std::vector<Change> fitted = {};    ///< what a fit has made of the model
};

/// What candidates are made for; refers to what the caller owns.
struct CandidateContext {
  const Experiment& experiment;
  const SearchBase& from;
  const Sizes& sizes;
};

/// Objects of one kind. A soft segment is named by its plugin instance, at Place::kBody; an output
/// by its first column (a turned sensor by its name), at Place::kSensor, where none is the clock.
struct ObjectSet {
  Place place;
  std::vector<std::string> names;
};

/// The hypothesis that an effect acts on some objects, with one value of each parameter for all of
/// them. option: of the effect's choice. Throws Error, saying why, where the model cannot have it
/// there.
Hypothesis HypothesisAt(const EffectInfo& effect, const Candidate& wanted, const ObjectSet& objects,
                        int option, const CandidateContext& context);

/// The number of hypotheses that an effect gives at one set of objects: the options of a dry
/// friction's choice.
int OptionCount(const EffectInfo& effect, const Candidate& wanted);

/// The same effect and choice as those of another hypothesis, on other objects of the same kind,
/// with one value of each parameter for all of them: a step of a forward selection, which begins
/// with the best of AtEach and adds one object after the other. Throws Error, saying why, where the
/// model cannot have it there, and for outputs of different units.
Hypothesis At(const Hypothesis& like, const std::vector<std::string>& objects,
              const CandidateContext& context);

/// The same on each single object of that kind, in the model's order, out of those that the
/// experiment's `where` allows. skipped: gets one sentence for each object where the model cannot
/// have it. Returns none for what belongs to the world or the clock.
std::vector<Hypothesis> AtEach(const Hypothesis& like, const CandidateContext& context,
                               std::vector<std::string>& skipped);

}  // namespace continuum
