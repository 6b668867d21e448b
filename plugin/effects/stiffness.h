#pragma once

#include "effects/effect.h"

namespace continuum {

/// Spring stiffness, as the native attribute.   τ = −k (q − q_0),  k [N*m/rad] replaces the
/// model's.
struct Stiffness {
  static constexpr std::string_view kName = "stiffness", kSource = "mujoco",
                                    kSummary = "another stiffness of the spring";
  static constexpr std::string_view kNative = "stiffness";
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr std::array kParams{Param{"k", "N*m/rad", 0, kInfinity, 1, kAsIs}};

  template <class Element>
  static void Apply(Element& element, const Vec<double, 1>& p) {
    element.Set(kNative, p[0]);
  }
};

}  // namespace continuum
