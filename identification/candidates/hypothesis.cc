#include "identification/candidates/hypothesis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "binding/config.h"
#include "binding/expression.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/measurement_candidates.h"
#include "identification/candidates/search_range.h"
#include "sim/experiment/measurement_model.h"
#include "sim/io/file.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

// A name that no instance of the model has.
std::string FreshInstance(const mjModel& m) {
  const std::string name = "diagnosis";
  for (int i = 1;; ++i) {
    std::string one = i == 1 ? name : name + std::to_string(i);
    if (mj_name2id(&m, mjOBJ_PLUGIN, one.c_str()) < 0) return one;
  }
}

// The name of an instance of another dry friction law on the same joints, and its effect.
struct Present {
  std::string instance, effect;
  bool same = false;  ///< on exactly these joints
  int id = -1;
};
Present FrictionOn(const mjModel& m, const std::vector<std::string>& joints) {
  Present found;
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string plugin = mjp_getPluginAtSlot(m.plugin[i])->name;
    if (!plugin.starts_with("continuum.")) continue;
    const std::string effect = plugin.substr(10);
    if (EffectNamed(effect).kind != EffectInfo::Kind::kFriction) continue;
    const auto ids = Config(m, i).Match(Place::kJoint);
    std::set<std::string> on;
    for (const int j : ids) on.insert(mj_id2name(&m, mjOBJ_JOINT, j));
    const std::set<std::string> wanted(joints.begin(), joints.end());
    std::vector<std::string> common;
    std::set_intersection(on.begin(), on.end(), wanted.begin(), wanted.end(),
                          std::back_inserter(common));
    if (common.empty()) continue;
    const char* name = mj_id2name(&m, mjOBJ_PLUGIN, i);
    found = {name ? name : "", effect, on == wanted, i};
  }
  return found;
}

// The attribute that an effect edits, in the experiment's words.
std::string AttributeOf(const EffectInfo& effect) {
  return effect.name == "viscous" ? "damping" : std::string(effect.name);
}

bool IsFitted(const Experiment& e, const std::string& kind, const std::string& attribute) {
  return std::any_of(e.parameters.begin(), e.parameters.end(), [&](const Parameter& p) {
    return p.target.starts_with(kind + ":") && p.attribute == attribute;
  });
}

// Whether a parameter of the experiment says already what an effect is at some objects, out of all
// of their kind: not where they are some of several that share one.
bool IsFitted(const Experiment& e, const EffectInfo& effect, Place place,
              const std::vector<std::string>& names, const std::vector<std::string>& all) {
  const std::string kind = std::string(PlaceName(place)) + ":";
  return std::any_of(e.parameters.begin(), e.parameters.end(), [&](const Parameter& p) {
    if (!p.target.starts_with(kind) || p.attribute != AttributeOf(effect)) return false;
    const auto acts = [&](const std::string& name) {
      return AnyGlobMatches(p.target.substr(kind.size()), name);
    };
    const auto here = std::count_if(names.begin(), names.end(), acts);
    return here > 0 &&
           (here < std::ssize(names) || here == std::count_if(all.begin(), all.end(), acts));
  });
}

Hypothesis EditCandidate(const EffectInfo& effect, Place place,
                         const std::vector<std::string>& names, const Experiment& e,
                         const SearchBase& from, Sizes sizes) {
  if (place == Place::kActuator) sizes.input = InputSize(e, names);
  Hypothesis h{std::string(effect.name), "", InWords(place, names), *from.system, {}, {}, "", {}};
  const std::string target =
      place == Place::kWorld ? "world" : std::string(PlaceName(place)) + ":" + Globs(names);
  for (Param param : effect.params) {
    const bool as_is = std::isnan(param.null);  // the effect is an attribute of the model
    if (as_is) param.null = from.system->ValueAfter(from.fitted, target, std::string(effect.name));
    h.extra.push_back(FreeOne(
        param, place, sizes, target,
        as_is ? std::string(effect.name) : fmt::format("effect:{}.{}", effect.name, param.name),
        Change::Operation::kSet));
    h.null.push_back(param.null);
  }
  return h;
}

Hypothesis PluginCandidate(const EffectInfo& effect, Place place,
                           const std::vector<std::string>& names, const ModelSpec& system,
                           const Sizes& sizes, int option) {
  EffectInstance added{std::string(effect.name),
                       FreshInstance(system.model()),
                       {{std::string(PlaceName(place)), Globs(names)}}};
  std::string variant;
  if (!effect.choices.empty() && effect.kind == EffectInfo::Kind::kFriction) {
    const Choice& choice = effect.choices.front();
    added.config.emplace_back(choice.name, choice.options[option]);
    variant = std::string(choice.name) + "=" + std::string(choice.options[option]);
  }
  Present present;
  if (effect.kind == EffectInfo::Kind::kFriction && place == Place::kJoint) {
    present = FrictionOn(system.model(), names);
  }
  // A law that contains the model's Coulomb friction takes its place (and keeps its name, so that
  // the experiment's parameters still find it).
  const bool replaces = present.effect == "coulomb" && present.same && !present.instance.empty() &&
                        effect.params.front().name != "" &&
                        std::any_of(effect.params.begin(), effect.params.end(),
                                    [](const Param& p) { return p.name == "tau_c"; });
  if (replaces) added.name = present.instance;
  Hypothesis h{std::string(effect.name), variant, InWords(place, names), system, {}, {}, "", {}};
  for (const Param& p : effect.params) {
    const bool dry_elsewhere = p.name == "tau_c" && present.id >= 0;
    if (p.name == "tau_c" && replaces) {
      const double tau_c = system.Value("plugin:" + present.instance, "tau_c");
      added.config.emplace_back("tau_c", Decimal(tau_c));
      continue;
    }
    // The native damping of joints says it already.
    const bool damping = p.unit == "N*m*s/rad" && p.null == 0;
    const bool literal = p.name == "k_v";
    if (dry_elsewhere || damping || literal) {
      if (!literal) added.config.emplace_back(p.name, "0");
      continue;
    }
    if (!std::isnan(p.held)) {
      added.config.emplace_back(p.name, Decimal(p.held));
      continue;
    }
    Parameter free = FreeOne(p, place, sizes, "plugin:" + added.name, std::string(p.name),
                             Change::Operation::kSet);
    added.config.emplace_back(p.name, Decimal(free.initial));
    h.extra.push_back(std::move(free));
    h.null.push_back(p.null);
  }
  h.system = replaces ? system.Replacing(present.instance, added) : system.With({}, {{added}});
  h.instance = added;
  if (replaces) h.replaces = present.instance;
  return h;
}

// A law that the experiment writes. Its parameters are p1, p2, .. of the instance.
Hypothesis WrittenCandidate(const EffectInfo& effect, const WrittenLaw& law, Place place,
                            const std::vector<std::string>& names, const ModelSpec& system) {
  Hypothesis h{law.name, "", InWords(place, names), system, {}, {}, "", {}};
  h.null = law.null;
  EffectInstance added{std::string(effect.name),
                       FreshInstance(system.model()),
                       {{std::string(PlaceName(place)), Globs(names)}}};
  std::vector<std::string> from, to;
  for (Parameter p : law.parameters) {
    p.target = "plugin:" + added.name;
    p.attribute = effect.params[h.extra.size()].name;
    from.push_back(p.name), to.push_back(p.attribute);
    added.config.emplace_back(p.attribute, Decimal(p.initial));
    h.extra.push_back(std::move(p));
  }
  added.config.emplace_back(effect.text, Expression::Renamed(law.formula, from, to));
  h.system = system.With({}, {{added}});
  h.instance = added;
  return h;
}

// The instances of soft segments that have all that an effect beside them takes from them: what has
// no null on its card.
std::vector<int> SegmentsFor(const mjModel& m, const EffectInfo& effect) {
  std::vector<int> found;
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string plugin = mjp_getPluginAtSlot(m.plugin[i])->name;
    if (!plugin.starts_with("continuum.") || plugin.substr(10) == effect.name) continue;
    const EffectInfo& other = EffectNamed(plugin.substr(10));
    if (other.kind != EffectInfo::Kind::kSegment) continue;
    const bool all = std::all_of(effect.params.begin(), effect.params.end(), [&](const Param& p) {
      return !std::isnan(p.null) || std::any_of(other.params.begin(), other.params.end(),
                                                [&](const Param& q) { return q.name == p.name; });
    });
    if (all) found.push_back(i);
  }
  return found;
}

// A law beside a soft segment of the model: places, choices and geometry are the segment's.
Hypothesis BesideCandidate(const EffectInfo& effect, int segment, const ModelSpec& system,
                           Sizes sizes) {
  const Config config(system.model(), segment);
  const std::string name = mj_id2name(&system.model(), mjOBJ_PLUGIN, segment);
  EffectInstance added{std::string(effect.name), FreshInstance(system.model()), {}};
  const auto copy = [&](std::string_view key) {
    if (const auto text = config.Get(key); !text.empty()) added.config.emplace_back(key, text);
  };
  for (const Place place : effect.places) copy(PlaceName(place));
  for (const Choice& choice : effect.choices) copy(choice.name);
  Hypothesis h{std::string(effect.name), "", "segment " + name, system, {}, {}, "", {}};
  for (const Param& p : effect.params) {
    if (std::isnan(p.null)) {
      const double value = system.Value("plugin:" + name, std::string(p.name));
      added.config.emplace_back(p.name, Decimal(value));
      if (p.name == "d") sizes.length = 0.05 * value;
      continue;
    }
    h.extra.push_back(FreeOne(p, Place::kBody, sizes, "plugin:" + added.name, std::string(p.name),
                              Change::Operation::kSet));
    added.config.emplace_back(p.name, Decimal(h.extra.back().initial));
    h.null.push_back(p.null);
  }
  h.system = system.With({}, {{added}});
  h.instance = added;
  return h;
}

// So many objects are few: each is tried too, beside all of them together.
constexpr std::size_t kFew = 4;

// The objects at which an effect that has no place is tried, out of those of one kind. first:
// whether it is the kind that it usually acts on; together: whether it may act on all of them.
std::vector<std::vector<std::string>> Choose(const std::vector<std::string>& names, Place place,
                                             bool first, bool together, SearchScope places) {
  std::vector<std::vector<std::string>> chosen;
  const bool others = places == SearchScope::kOthers;
  if (!first && place != Place::kTendon) return chosen;  // a site is a body's
  if (together && others != first) chosen.push_back(names);
  const bool one_by_one = (names.size() > kFew || !first || !together) == others;
  for (std::size_t i = 0; one_by_one && names.size() > 1 && i < names.size(); ++i)
    chosen.push_back({names[i]});
  return chosen;
}

// Why an effect makes no sense at places of a model; empty when it does.
std::string WhyNot(const EffectInfo& effect, Place place, const std::vector<std::string>& names,
                   const Experiment& e, const mjModel& m) {
  if (effect.kind == EffectInfo::Kind::kEdit) {
    if (IsFitted(e, effect, place, names, PlacesFor(m, effect, place, "*", e)))
      return "the experiment fits it already";
    if (effect.name == "viscous" && place == Place::kJoint &&
        FrictionOn(m, names).effect == "stribeck") {
      return "the model's stribeck has it: fit its tau_mu";
    }
  }
  if (effect.kind == EffectInfo::Kind::kFriction) {
    const Present present = FrictionOn(m, names);
    if (present.effect == effect.name) return "the model has it already";
    if (effect.name == "coulomb" && present.id >= 0) return "the model has dry friction";
  }
  if (effect.kind == EffectInfo::Kind::kPath) {
    for (int i = 0; i < m.nplugin; ++i) {
      const std::string name = mjp_getPluginAtSlot(m.plugin[i])->name;
      if (name == "continuum." + std::string(effect.name)) return "the model has it already";
    }
  }
  return "";
}

// One hypothesis, or one for each option of a friction's choice.
void AddAt(const EffectInfo& effect, const Candidate& wanted, Place place,
           const std::vector<std::string>& names, const Experiment& e, const SearchBase& from,
           const Sizes& sizes, std::vector<Hypothesis>& all) {
  const ModelSpec& system = *from.system;
  if (wanted.law) {
    all.push_back(WrittenCandidate(effect, *wanted.law, place, names, system));
    return;
  }
  if (effect.kind == EffectInfo::Kind::kEdit) {
    all.push_back(EditCandidate(effect, place, names, e, from, sizes));
    return;
  }
  const bool choice = effect.kind == EffectInfo::Kind::kFriction && !effect.choices.empty();
  const std::size_t options = choice ? effect.choices.front().options.size() : 1;
  for (std::size_t o = 0; o < options; ++o)
    all.push_back(PluginCandidate(effect, place, names, system, sizes, static_cast<int>(o)));
}

// Why a law of soft segments was not added; empty when it was.
std::string AddBeside(const EffectInfo& effect, const Experiment& e, const ModelSpec& system,
                      const Sizes& sizes, std::vector<Hypothesis>& all) {
  const mjModel& m = system.model();
  if (HasEffect(m, effect.name)) return "the model has it already";
  const auto segments = SegmentsFor(m, effect);
  if (segments.empty()) return "no soft segment in the model";
  for (const Param& p : effect.params) {
    if (!std::isnan(p.null) && IsFitted(e, "plugin", std::string(p.name)))
      return "the experiment fits it already";
  }
  for (const int i : segments) all.push_back(BesideCandidate(effect, i, system, sizes));
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
    if (!anywhere && wanted.where.substr(0, colon) != PlaceName(place)) continue;
    const std::string glob = anywhere ? "*" : wanted.where.substr(colon + 1);
    const auto names = PlacesFor(m, effect, place, glob, e);
    if (names.empty()) continue;
    const auto why = [&](const std::vector<std::string>& some) {
      return wanted.law ? "" : WhyNot(effect, place, some, e, m);
    };
    const bool together = why(names).empty();
    if (few && first && !together) return skipped.push_back(wanted.Name() + ": " + why(names));
    std::vector<std::vector<std::string>> chosen;
    if (anywhere) chosen = Choose(names, place, first, together, places);
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
    const std::string why = few ? AddBeside(effect, e, *from.system, sizes, all) : "";
    if (!why.empty()) skip(why);
  } else if (effect.kind == EffectInfo::Kind::kMeasure) {
    if (!few) return;
    auto found = MeasureCandidates(effect, wanted, e, *from.system, sizes);
    if (found.empty()) skip("no output that it acts on");
    std::move(found.begin(), found.end(), std::back_inserter(all));
  } else {
    AddAtObjects(effect, wanted, e, from, sizes, places, all, skipped);
  }
}

}  // namespace

std::vector<std::size_t> Hypothesis::Amplitudes() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < null.size(); ++i) {
    if (!std::isnan(null[i])) out.push_back(i);
  }
  return out;
}

std::size_t Hypothesis::Main(std::span<const double> values) const {
  std::size_t main = 0;
  double largest = -1;
  for (const std::size_t i : Amplitudes()) {
    const double size = std::abs(values[i] - null[i]) /
                        std::max(std::abs(extra[i].lower), std::abs(extra[i].upper));
    if (size > largest) main = i, largest = size;
  }
  return main;
}

double Hypothesis::AtShare(std::size_t i, double value, double share) const {
  if (!std::isinf(null[i])) return null[i] + share * (value - null[i]);
  return share > 0 ? value / share : extra[i].upper;
}

bool Hypothesis::OnlyMeasured() const {
  return !extra.empty() && std::all_of(extra.begin(), extra.end(), [](const Parameter& p) {
    return IsMeasurement(p.target, p.attribute);
  });
}

std::vector<Parameter> Hypothesis::Free() const {
  std::vector<Parameter> all = given;
  all.insert(all.end(), extra.begin(), extra.end());
  return all;
}

namespace {

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
  for (Hypothesis& h : all) h.starts = StartsOf(h.extra, h.null), h.given = from.given;
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
