#include "identification/candidates/model_candidates.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "binding/config.h"
#include "binding/expression.h"
#include "effects/formula.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/present_friction.h"
#include "identification/candidates/search_range.h"
#include "identification/candidates/shared_value.h"
#include "identification/problem/parameter_units.h"
#include "sim/io/decimal.h"

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

// Whether a law that contains Coulomb's can take the place of the model's friction, and keep its
// name, so that the experiment's parameters still find it.
bool Replaceable(const PresentFriction& present) {
  return present && present.effect->IsConstantFriction() && present.same &&
         !present.instance.empty();
}

// The value of a parameter that is not free, as the model, or another parameter, says it already.
std::optional<double> FixedValue(const EffectInfo& effect, std::size_t i,
                                 const PresentFriction& present, const ModelSpec& system) {
  const Param& p = effect.params[i];
  if (i == effect.coulomb_level && Replaceable(present)) {
    const std::string level(present.effect->params[*present.effect->coulomb_level].name);
    return system.Value("plugin:" + present.instance, level);
  }
  if (i == effect.coulomb_level && present) return 0;
  if (!std::isnan(p.held)) return p.held;
  return std::nullopt;
}

// What the elements have of an attribute.
std::vector<double> ValuesOf(const std::string& attribute, Place place,
                             const std::vector<std::string>& names, const ModelSpec& system,
                             const std::vector<Change>& fitted) {
  const std::string kind = std::string(PlaceName(place)) + ":";
  std::vector<double> values;
  for (const std::string& name : names)
    values.push_back(system.ValueAfter(fitted, kind + Escaped(name), attribute));
  return values;
}

double Least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

// Where the effect is another value of an attribute of the model.
void AddAttribute(const EffectInfo& effect, Param param, Place place,
                  const std::vector<std::string>& names, const ModelSpec& system,
                  const std::vector<Change>& fitted, const Sizes& sizes, Hypothesis& h) {
  const std::string kind = std::string(PlaceName(place)) + ":", attribute(effect.native);
  const std::vector<double> values = ValuesOf(attribute, place, names, system, fitted);
  const SharedValue shared = SharedValueOf(values);
  param.null = shared.null;
  if (shared.operation == Change::Operation::kScale) param.unit = "1";
  if (shared.operation == Change::Operation::kAdd) param.lower -= Least(values);
  h.extra.push_back(
      CandidateParameter(param, place, sizes, kind + GlobsOf(names), attribute, shared.operation));
  if (!shared.suffix.empty()) {
    h.extra.back().name += shared.suffix;
    h.extra.back().unit = UnitOf(system, h.extra.back());  // no card has this name
  }
  h.null.push_back(param.null);
}

}  // namespace

Hypothesis EditCandidate(const EffectInfo& effect, Place place,
                         const std::vector<std::string>& names, const Experiment& e,
                         const ModelSpec& system, const std::vector<Change>& fitted, Sizes sizes) {
  if (place == Place::kActuator) sizes.input = InputSize(e, names);
  if (place == Place::kJoint) sizes.inertia = InertiaOf(system.model(), names);
  if (place == Place::kBody || place == Place::kSite)
    sizes.lever = LeverOf(system.model(), place, names);
  Hypothesis h{std::string(effect.name), "", PlaceText(place, names), system, {}, {}, "", {}};
  const std::string target =
      place == Place::kWorld ? "world" : std::string(PlaceName(place)) + ":" + GlobsOf(names);
  for (const Param& param : effect.params) {
    if (std::isnan(param.null)) {
      AddAttribute(effect, param, place, names, system, fitted, sizes, h);
      continue;
    }
    if (param.held == param.null) continue;
    h.extra.push_back(CandidateParameter(param, place, sizes, target,
                                         fmt::format("effect:{}.{}", effect.name, param.name),
                                         Change::Operation::kSet));
    h.null.push_back(param.null);
    if (effect.adds_to.empty()) continue;  // else it may take away what all of them have
    h.extra.back().lower =
        -Least(ValuesOf(std::string(effect.adds_to), place, names, system, fitted));
  }
  return h;
}

Hypothesis PluginCandidate(const EffectInfo& effect, Place place,
                           const std::vector<std::string>& names, const ModelSpec& system,
                           const Sizes& sizes, int option) {
  EffectInstance added{std::string(effect.name),
                       FreshInstance(system.model()),
                       {{std::string(PlaceName(place)), GlobsOf(names)}}};
  std::string variant;
  if (!effect.choices.empty() && effect.kind == EffectInfo::Kind::kFriction) {
    const Choice& choice = effect.choices.front();
    added.config.emplace_back(choice.name, choice.options[option]);
    variant = std::string(choice.name) + "=" + std::string(choice.options[option]);
  }
  PresentFriction present;
  if (effect.kind == EffectInfo::Kind::kFriction && place == Place::kJoint) {
    present = PresentFrictionOn(system.model(), place, names);
  }
  const bool replaces = effect.coulomb_level && Replaceable(present);
  if (replaces) added.name = present.instance;
  Hypothesis h{std::string(effect.name), variant, PlaceText(place, names), system, {}, {}, "", {}};
  for (std::size_t i = 0; i < effect.params.size(); ++i) {
    const Param& p = effect.params[i];
    if (i == effect.literal) continue;
    if (const auto fixed = FixedValue(effect, i, present, system)) {
      added.config.emplace_back(p.name, Decimal(*fixed));
      continue;
    }
    Parameter free = effect.kind == EffectInfo::Kind::kPath
                         ? CableParameter(p, sizes, "plugin:" + added.name)
                         : CandidateParameter(p, place, sizes, "plugin:" + added.name,
                                              std::string(p.name), Change::Operation::kSet);
    added.config.emplace_back(p.name, Decimal(free.initial));
    h.extra.push_back(std::move(free));
    h.null.push_back(p.null);
  }
  h.system = replaces ? system.Replacing(present.instance, added) : system.With({}, {{added}});
  h.instance = added;
  if (replaces) h.replaces = present.instance;
  return h;
}

Hypothesis FormulaCandidate(const EffectInfo& effect, const WrittenLaw& law, Place place,
                            const std::vector<std::string>& names, const ModelSpec& system) {
  Hypothesis h{law.name, "", PlaceText(place, names), system, {}, {}, "", {}};
  h.null = law.null;
  EffectInstance added{std::string(effect.name),
                       FreshInstance(system.model()),
                       {{std::string(PlaceName(place)), GlobsOf(names)}}};
  std::vector<std::string> from, to;
  for (Parameter p : law.parameters) {
    p.target = "plugin:" + added.name;
    const bool by_name = p.name == Formula::kHeatTime;
    p.attribute = by_name ? p.name : effect.params[from.size()].name;
    if (!by_name) from.push_back(p.name), to.push_back(p.attribute);
    added.config.emplace_back(p.attribute, Decimal(p.initial));
    h.extra.push_back(std::move(p));
  }
  added.config.emplace_back(effect.text, Expression::Renamed(law.formula, from, to));
  h.system = system.With({}, {{added}});
  h.instance = added;
  return h;
}

std::vector<std::string> SegmentsFor(const mjModel& m, const EffectInfo& effect) {
  std::vector<std::string> found;
  for (int i = 0; i < m.nplugin; ++i) {
    const EffectInfo* const other = EffectOf(m, i);
    if (!other || other->name == effect.name || other->kind != EffectInfo::Kind::kSegment) continue;
    const bool all = std::all_of(effect.params.begin(), effect.params.end(), [&](const Param& p) {
      return !std::isnan(p.null) || std::any_of(other->params.begin(), other->params.end(),
                                                [&](const Param& q) { return q.name == p.name; });
    });
    const char* const name = mj_id2name(&m, mjOBJ_PLUGIN, i);
    if (all && name) found.emplace_back(name);
  }
  return found;
}

Hypothesis SegmentCandidate(const EffectInfo& effect, const std::vector<std::string>& names,
                            const ModelSpec& system, Sizes sizes) {
  if (names.size() != 1)
    throw Error::Input(std::string(effect.name), "one soft segment", std::to_string(names.size()));
  const std::string& name = names.front();
  const Config config(system.model(), mj_name2id(&system.model(), mjOBJ_PLUGIN, name.c_str()));
  EffectInstance added{std::string(effect.name), FreshInstance(system.model()), {}};
  const auto copy = [&](std::string_view key) {
    if (const auto text = config.Get(key); !text.empty()) added.config.emplace_back(key, text);
  };
  for (const Place place : effect.places) copy(PlaceName(place));
  for (const Choice& choice : effect.choices) copy(choice.name);
  Hypothesis h{std::string(effect.name), "", "segment " + name, system, {}, {}, "", {}};
  for (std::size_t i = 0; i < effect.params.size(); ++i) {
    const Param& p = effect.params[i];
    if (std::isnan(p.null)) {
      const double value = system.Value("plugin:" + name, std::string(p.name));
      added.config.emplace_back(p.name, Decimal(value));
      if (i == effect.arc_radius) sizes.length = 0.05 * value;
      continue;
    }
    h.extra.push_back(CandidateParameter(p, Place::kBody, sizes, "plugin:" + added.name,
                                         std::string(p.name), Change::Operation::kSet));
    added.config.emplace_back(p.name, Decimal(h.extra.back().initial));
    h.null.push_back(p.null);
  }
  h.system = system.With({}, {{added}});
  h.instance = added;
  return h;
}

}  // namespace continuum
