#pragma once

#include "effects/effect.h"

namespace continuum {

/// Viscous friction, as native damping.   τ = −b v,  b [N*m*s/rad] added to what the model has.
struct Viscous {
  static constexpr std::string_view kName = "viscous", kSource = "mujoco",
                                    kSummary = "viscous friction";
  static constexpr std::string_view kNative = "damping";
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr std::array kParams{Magnitude("b", "N*m*s/rad", 0.01)};

  template <class Element>
  static void Apply(Element& element, const Vec<double, 1>& p) {
    element.Add(kNative, p[0]);
  }
};

}  // namespace continuum
