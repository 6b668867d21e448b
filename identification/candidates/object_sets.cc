#include "identification/candidates/object_sets.h"

#include <algorithm>

#include "error.h"
#include "identification/candidates/conflicts.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/measurement_candidates.h"
#include "identification/candidates/model_candidates.h"
#include "identification/candidates/per_condition.h"
#include "identification/candidates/search_range.h"
#include "identification/candidates/shown_units.h"
#include "sim/experiment/measurement_model.h"

namespace continuum {
namespace {

using Kind = EffectInfo::Kind;

// Whether the model takes the values that a search begins with.
void RequireModel(const Hypothesis& h) {
  std::vector<Change> changes;
  for (const Parameter& p : h.extra) {
    if (!IsMeasurement(p.target, p.attribute))
      changes.push_back({p.target, p.attribute, p.initial, p.operation});
  }
  h.system.Build(changes);
}

Sizes SizesAt(const ObjectSet& objects, const CandidateContext& c) {
  const mjModel& m = c.from.system->model();
  if (objects.place == Place::kJoint) return c.sizes.OfJoints(m, objects.names);
  return objects.place == Place::kActuator ? c.sizes.OfActuators(m, objects.names) : c.sizes;
}

Hypothesis MakeAt(const EffectInfo& effect, const Candidate& wanted, const ObjectSet& objects,
                  int option, const Sizes& sizes, const CandidateContext& c) {
  const auto& [place, names] = objects;
  const ModelSpec& system = *c.from.system;
  if (wanted.law) return FormulaCandidate(effect, *wanted.law, place, names, system);
  switch (effect.kind) {
    case Kind::kMeasure:
      return MeasurementCandidate(effect, names, c.experiment, system, sizes);
    case Kind::kSegment:
      return SegmentCandidate(effect, names, system, sizes);
    case Kind::kEdit: {
      Hypothesis h =
          EditCandidate(effect, place, names, c.experiment, system, c.from.fitted, sizes);
      RequireModel(h);
      return h;
    }
    default:
      return PluginCandidate(effect, place, names, system, sizes, option);
  }
}

// The objects that a hypothesis of an effect may be about, out of those of one kind.
std::vector<std::string> ObjectsOf(const EffectInfo& effect, const Hypothesis& like,
                                   const CandidateContext& c) {
  const mjModel& m = c.from.system->model();
  const std::string& where = like.candidate.where;
  const std::string globs = where.empty() ? "*" : where.substr(where.find(':') + 1);
  if (effect.kind == Kind::kSegment) return SegmentsFor(m, effect);
  if (effect.kind == Kind::kMeasure)
    return like.objects.empty() ? like.objects : OutputsFor(effect, globs, c.experiment, m);
  if (like.place == Place::kWorld) return {};
  return PlacesFor(m, effect, like.place, globs, c.experiment);
}

}  // namespace

int OptionCount(const EffectInfo& effect, const Candidate& wanted) {
  const bool choice = effect.kind == Kind::kFriction && !effect.choices.empty() && !wanted.law;
  return choice ? static_cast<int>(effect.choices.front().options.size()) : 1;
}

Hypothesis HypothesisAt(const EffectInfo& effect, const Candidate& wanted, const ObjectSet& objects,
                        int option, const CandidateContext& c) {
  const Sizes sizes = SizesAt(objects, c);
  Hypothesis h = MakeAt(effect, wanted, objects, option, sizes, c);
  h.candidate = wanted, h.option = option;
  h.place = objects.place, h.objects = objects.names;
  h.units = ShownUnits(effect, objects.place, objects.names, c.experiment, c.from.system->model());
  if (wanted.per_condition) SplitByCondition(h, TrainedConditions(c.experiment, wanted.Name()));
  h.starts = SearchStarts(h, effect.params, sizes);
  h.given = c.from.given;
  return h;
}

Hypothesis At(const Hypothesis& like, const std::vector<std::string>& objects,
              const CandidateContext& c) {
  const EffectInfo& effect = EffectNamed(like.candidate.effect);
  if (!like.candidate.law) {
    const std::string why =
        ConflictAt(effect, like.place, objects, c.experiment, c.from.system->model());
    if (!why.empty()) throw Error::Input(like.Name(), why);
  }
  return HypothesisAt(effect, like.candidate, {like.place, objects}, like.option, c);
}

std::vector<Hypothesis> AtEach(const Hypothesis& like, const CandidateContext& c,
                               std::vector<std::string>& skipped) {
  std::vector<Hypothesis> all;
  for (const std::string& name : ObjectsOf(EffectNamed(like.candidate.effect), like, c)) {
    try {
      all.push_back(At(like, {name}, c));
    } catch (const Error& error) {
      skipped.push_back(like.Name() + " at " + PlaceText(like.place, {name}) + ": " + error.what());
    }
  }
  return all;
}

}  // namespace continuum
