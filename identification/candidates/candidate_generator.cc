#include "identification/candidates/candidate_generator.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "binding/config.h"
#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/measurement_candidates.h"
#include "identification/candidates/model_candidates.h"
#include "identification/candidates/present_friction.h"
#include "identification/candidates/search_range.h"

namespace continuum {
namespace {

// Why candidates are skipped.
constexpr const char* kHasIt = "the model has it already";
constexpr const char* kFitsIt = "the experiment fits it already";

bool IsFitted(const Experiment& e, const std::string& kind, const std::string& attribute) {
  return std::any_of(e.parameters.begin(), e.parameters.end(), [&](const Parameter& p) {
    return p.target.starts_with(kind + ":") && p.attribute == attribute;
  });
}

// Whether a parameter of the experiment says already what an effect is at some objects, out of all
// of their kind: not where they are some of several that share one.
bool IsFitted(const Experiment& e, const EffectInfo& effect, Place place,
              const std::vector<std::string>& names, const std::vector<std::string>& all) {
  if (effect.native.empty()) return false;
  const std::string kind = std::string(PlaceName(place)) + ":";
  return std::any_of(e.parameters.begin(), e.parameters.end(), [&](const Parameter& p) {
    if (!p.target.starts_with(kind) || p.attribute != effect.native) return false;
    const auto acts = [&](const std::string& name) {
      return AnyGlobMatches(p.target.substr(kind.size()), name);
    };
    const auto here = std::count_if(names.begin(), names.end(), acts);
    return here > 0 &&
           (here < std::ssize(names) || here == std::count_if(all.begin(), all.end(), acts));
  });
}

// So many objects are few: each is tried too, beside all of them together.
constexpr std::size_t kFew = 4;

// The objects at which an effect that has no place is tried, out of those of one kind. first:
// whether it is the kind that it usually acts on; together: whether it may act on all of them.
std::vector<std::vector<std::string>> ObjectsToTry(const std::vector<std::string>& names,
                                                   Place place, bool first, bool together,
                                                   SearchScope places) {
  std::vector<std::vector<std::string>> chosen;
  const bool others = places == SearchScope::kOthers;
  if (!first && place != Place::kTendon) return chosen;
  if (together && others != first) chosen.push_back(names);
  const bool one_by_one = (names.size() > kFew || !first || !together) == others;
  for (std::size_t i = 0; one_by_one && names.size() > 1 && i < names.size(); ++i)
    chosen.push_back({names[i]});
  return chosen;
}

// Whether a model has an instance of an effect.
bool HasInstanceOf(const mjModel& m, const EffectInfo& effect) {
  for (int i = 0; i < m.nplugin; ++i) {
    const EffectInfo* const other = EffectOf(m, i);
    if (other && other->name == effect.name) return true;
  }
  return false;
}

// Why a dry friction makes no sense on joints that have one.
std::string WhyNoFriction(const EffectInfo& effect, const PresentFriction& present) {
  if (!present) return "";
  if (present.effect->name == effect.name) return kHasIt;
  return effect.IsConstantFriction() ? "the model has dry friction" : "";
}

// Why an effect makes no sense at places of a model; empty when it does.
std::string WhyNot(const EffectInfo& effect, Place place, const std::vector<std::string>& names,
                   const Experiment& e, const mjModel& m) {
  using Kind = EffectInfo::Kind;
  if (effect.kind == Kind::kFriction)
    return WhyNoFriction(effect, PresentFrictionOn(m, place, names));
  if (effect.kind == Kind::kPath) return HasInstanceOf(m, effect) ? kHasIt : "";
  if (effect.kind != Kind::kEdit) return "";
  if (IsFitted(e, effect, place, names, PlacesFor(m, effect, place, "*", e))) return kFitsIt;
  if (effect.native != "damping" || place != Place::kJoint) return "";
  const PresentFriction present = PresentFrictionOn(m, place, names);
  if (!present || !present.effect->damping) return "";
  return fmt::format("the model's {} has it: fit its {}", present.effect->name,
                     present.effect->params[*present.effect->damping].name);
}

// One hypothesis, or one for each option of a friction's choice.
void AddAt(const EffectInfo& effect, const Candidate& wanted, Place place,
           const std::vector<std::string>& names, const Experiment& e, const SearchBase& from,
           const Sizes& sizes, std::vector<Hypothesis>& all) {
  const ModelSpec& system = *from.system;
  if (wanted.law) {
    all.push_back(FormulaCandidate(effect, *wanted.law, place, names, system));
    return;
  }
  if (effect.kind == EffectInfo::Kind::kEdit) {
    all.push_back(EditCandidate(effect, place, names, e, system, from.fitted, sizes));
    return;
  }
  const bool choice = effect.kind == EffectInfo::Kind::kFriction && !effect.choices.empty();
  const std::size_t options = choice ? effect.choices.front().options.size() : 1;
  for (std::size_t o = 0; o < options; ++o)
    all.push_back(PluginCandidate(effect, place, names, system, sizes, static_cast<int>(o)));
}

// Why a law of soft segments was not added; empty when it was.
std::string AddBesideSegments(const EffectInfo& effect, const Experiment& e,
                              const ModelSpec& system, const Sizes& sizes,
                              std::vector<Hypothesis>& all) {
  const mjModel& m = system.model();
  if (HasInstanceOf(m, effect)) return kHasIt;
  const auto segments = SegmentsFor(m, effect);
  if (segments.empty()) return "no soft segment in the model";
  for (const Param& p : effect.params) {
    if (!std::isnan(p.null) && IsFitted(e, "plugin", std::string(p.name))) return kFitsIt;
  }
  for (const int i : segments) all.push_back(SegmentCandidate(effect, i, system, sizes));
  return "";
}

// At objects of the model. Throws Error where the experiment asks for a place that it has not.
void AddAtObjects(const EffectInfo& effect, const Candidate& wanted, const Experiment& e,
                  const SearchBase& from, const Sizes& sizes, SearchScope places,
                  std::vector<Hypothesis>& all, std::vector<std::string>& skipped) {
  const mjModel& m = from.system->model();
  const std::size_t colon = wanted.where.find(':');
  const bool anywhere = wanted.where.empty(), few = places == SearchScope::kFew;
  bool first = true;
  for (const Place place : effect.places) {
    if (anywhere ? place == Place::kSite : wanted.where.substr(0, colon) != PlaceName(place))
      continue;  // a site is a body's
    const std::string glob = anywhere ? "*" : wanted.where.substr(colon + 1);
    const auto names = PlacesFor(m, effect, place, glob, e);
    if (names.empty()) continue;
    const auto why = [&](const std::vector<std::string>& some) {
      return wanted.law ? "" : WhyNot(effect, place, some, e, m);
    };
    const bool together = why(names).empty();
    if (few && first && !together) return skipped.push_back(wanted.Name() + ": " + why(names));
    std::vector<std::vector<std::string>> chosen;
    if (anywhere) chosen = ObjectsToTry(names, place, first, together, places);
    if (!anywhere && few) chosen.push_back(names);
    for (const auto& some : chosen) {
      if (why(some).empty()) AddAt(effect, wanted, place, some, e, from, sizes, all);
    }
    first = false;
  }
  if (!first) return;
  if (!anywhere) {
    throw Error::Input(fmt::format("{}: candidates: {}", e.file.string(), wanted.Name()),
                       "a place in the model where the effect can act", wanted.where);
  }
  skipped.push_back(wanted.Name() + ": nothing in the model to bind it to");
}

void AddEffect(const EffectInfo& effect, const Candidate& wanted, const Experiment& e,
               const SearchBase& from, const Sizes& sizes, SearchScope places,
               std::vector<Hypothesis>& all, std::vector<std::string>& skipped) {
  const auto skip = [&](const std::string& why) { skipped.push_back(wanted.Name() + ": " + why); };
  const bool few = places == SearchScope::kFew;  // of segments and sensors these leave nothing out
  if (effect.kind == EffectInfo::Kind::kSegment) {
    const std::string why = few ? AddBesideSegments(effect, e, *from.system, sizes, all) : "";
    if (!why.empty()) skip(why);
  } else if (effect.kind == EffectInfo::Kind::kMeasure) {
    if (!few) return;
    auto found = MeasurementCandidates(effect, wanted, e, *from.system, sizes);
    if (found.empty()) skip("no output that it acts on");
    std::move(found.begin(), found.end(), std::back_inserter(all));
  } else {
    AddAtObjects(effect, wanted, e, from, sizes, places, all, skipped);
  }
}

// The conditions of an experiment, all of which it can be trained on.
std::set<std::string> Conditions(const Experiment& e, const std::string& candidate) {
  const std::string where = fmt::format("{}: candidates: {}: per", e.file.string(), candidate);
  std::set<std::string> all, trained;
  for (const Log& log : e.logs) {
    if (log.condition.empty()) continue;
    all.insert(log.condition);
    if (log.train) trained.insert(log.condition);
  }
  if (all.size() < 2)
    throw Error::Input(where, "logs of two conditions or more", std::to_string(all.size()));
  for (const std::string& name : all) {
    if (!trained.contains(name))
      throw Error::Input(where, "a train log of every condition", "none of '" + name + "'");
  }
  return all;
}

// The same effect with values of its own under each condition.
void Multiply(Hypothesis& h, const std::set<std::string>& conditions) {
  std::vector<Parameter> extra;
  std::vector<double> null;
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    for (const std::string& name : conditions) {
      extra.push_back(h.extra[i]);
      extra.back().name += "[" + name + "]";
      extra.back().condition = name;
      null.push_back(h.null[i]);
    }
  }
  h.extra = std::move(extra), h.null = std::move(null);
  h.where += ", per condition";
}

}  // namespace

std::vector<Hypothesis> MakeCandidates(const Experiment& e, const SearchBase& from,
                                       const Sizes& sizes, std::vector<std::string>& skipped,
                                       SearchScope places) {
  std::vector<Hypothesis> all;
  if (e.all_candidates) {
    for (const EffectInfo& effect : Catalog())
      AddEffect(effect, {std::string(effect.name), "", false}, e, from, sizes, places, all,
                skipped);
  } else {
    std::vector<Candidate> seen;
    for (const Candidate& c : e.candidates) {
      if (std::find(seen.begin(), seen.end(), c) != seen.end()) continue;
      seen.push_back(c);
      const EffectInfo& effect = EffectNamed(c.effect);
      if (c.per_condition && effect.kind == EffectInfo::Kind::kMeasure)
        throw Error::Input(fmt::format("{}: candidates: {}: per", e.file.string(), c.Name()),
                           "an effect of the model", "one of the measurement");
      const std::size_t first = all.size();
      AddEffect(effect, c, e, from, sizes, places, all, skipped);
      for (std::size_t i = first; c.per_condition && i < all.size(); ++i)
        Multiply(all[i], Conditions(e, c.Name()));
    }
  }
  for (Hypothesis& h : all) h.starts = SearchStarts(h.extra, h.null), h.given = from.given;
  return all;
}

std::vector<std::string> Unlisted(const Experiment& e, const std::vector<std::string>& names) {
  std::set<std::string> listed(names.begin(), names.end());
  if (names.empty()) {
    for (const Candidate& c : e.candidates) listed.insert(c.effect);
  }
  std::vector<std::string> others;
  if (listed.empty() || (names.empty() && e.all_candidates)) return others;
  for (const EffectInfo& effect : Catalog()) {
    if (!listed.contains(std::string(effect.name))) others.emplace_back(effect.name);
  }
  return others;
}

}  // namespace continuum
