#pragma once

#include "effects/effect.h"

namespace continuum {

/// Inertia of rotor and gear, as the native attribute.   I_a [kg*m^2] replaces the model's.
struct Armature {
  static constexpr std::string_view kName = "armature", kSource = "mujoco",
                                    kSummary = "another inertia of rotor and gear";
  static constexpr std::string_view kNative = "armature";
  static constexpr Kinship kKin{kInertia};
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr std::array kParams{Param{"armature", "kg*m^2", 0, kInfinity, 1e-3, kAsIs}};

  template <class Element>
  static void Apply(Element& joint, const Vec<double, 1>& p) {
    joint.Set(kNative, p[0]);
  }
};

}  // namespace continuum
