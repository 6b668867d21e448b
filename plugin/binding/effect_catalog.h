#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "effects/effect.h"

namespace continuum {

/// What can be said of an effect without its type.
struct EffectInfo {
  enum class Kind { kForce, kFriction, kPath, kSegment, kSignal, kMeasure, kEdit };
  std::string_view name, summary, source;
  Kind kind;
  std::vector<Place> places;
  std::vector<Param> params;
  std::vector<Choice> choices;
  std::optional<Tap> tap = {};    ///< where a Signal is inserted
  bool remembers = false;         ///< a law with states of its own
  bool only_listed = false;       ///< no candidate where the experiment does not name it
  std::string_view text = {};     ///< key of the formula that a law of the MJCF is written under
  std::string_view native = {};   ///< attribute of MuJoCo that an Edit is, in MJCF's words
  std::string_view adds_to = {};  ///< that of an element to which an Edit's value is added
  Kinship kin = {};               ///< its family; none where that has no name
  /// Indices of parameters that the cards of frictions and segments speak of (effects/effect.h).
  std::optional<std::size_t> coulomb_level = {}, damping = {}, literal = {}, arc_radius = {};

  /// Whether it is a dry friction of constant level and nothing else.
  bool IsConstantFriction() const { return coulomb_level && params.size() == 1; }
};

/// Every effect of the list, in its order.
const std::vector<EffectInfo>& Catalog();
/// Of the list, or of those whose law is written where they are used. Throws Error, listing the
/// former, when there is none of this name.
const EffectInfo& EffectNamed(std::string_view name);

/// The name of that of a plugin instance of a model; empty where the instance is not one of ours.
std::string_view EffectNameOf(const mjModel& m, int instance);
/// The effect of a plugin instance of a model; none where the instance is not one of ours.
const EffectInfo* EffectOf(const mjModel& m, int instance);

/// "friction", "force", …
std::string_view KindName(EffectInfo::Kind kind);
/// "row", "force", "native", …: what the effect becomes in an extended model.
std::string_view Becomes(EffectInfo::Kind kind);

}  // namespace continuum
