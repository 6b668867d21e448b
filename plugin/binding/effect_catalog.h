#pragma once

#include <string>
#include <string_view>
#include <vector>

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
  bool servo = false;  ///< a Signal at the error of a position servo
  std::string_view
      text;  ///< key of the formula, of an effect whose law is written where it is used
};

/// Every effect of the list, in its order.
const std::vector<EffectInfo>& Catalog();
/// Of the list, or of those whose law is written where they are used. Throws Error, listing the
/// former, when there is none of this name.
const EffectInfo& EffectNamed(std::string_view name);

/// "friction", "force", …
std::string_view KindName(EffectInfo::Kind kind);
/// The MJCF key of a place: "joint".
std::string_view PlaceName(Place place);
/// "row", "force", "native", …: what the effect becomes in an extended model.
std::string_view Becomes(EffectInfo::Kind kind);

}  // namespace continuum
