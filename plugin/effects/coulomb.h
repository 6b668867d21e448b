#pragma once

#include "effects/effect.h"

namespace continuum {

/// Coulomb dry friction.
///
///   |τ_f| ≤ τ_c        τ_c [N*m]  level, at rest and in sliding       (1)
///
/// Port: joint or tendon. Sliding: τ_f = τ_c sgn(v), opposing v.
/// Source: coulomb1785.
struct Coulomb {
  static constexpr std::string_view kName = "coulomb", kSource = "coulomb1785",
                                    kSummary = "dry friction of constant level";
  static constexpr Kinship kKin{kDryFriction};
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr Joints kJoints = Joints::kHingeSlideBall;
  static constexpr std::array kParams{Magnitude("tau_c", "N*m", 0.01)};
  static constexpr std::size_t kCoulombLevel = 0;

  template <class T>
  static T Level(const FrictionState<T>&, const Vec<T, 1>& p) {
    const auto& [tau_c] = p;
    return tau_c;  // (1)
  }
};

}  // namespace continuum
