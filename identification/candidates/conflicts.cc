#include "identification/candidates/conflicts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "binding/config.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/present_friction.h"

namespace continuum {
namespace {

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

}  // namespace

std::string ConflictAt(const EffectInfo& effect, Place place, const std::vector<std::string>& names,
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

std::string ConflictBesideSegments(const EffectInfo& effect, const Experiment& e,
                                   const mjModel& m) {
  if (HasInstanceOf(m, effect)) return kHasIt;
  for (const Param& p : effect.params) {
    if (!std::isnan(p.null) && IsFitted(e, "plugin", std::string(p.name))) return kFitsIt;
  }
  return "";
}

}  // namespace continuum
