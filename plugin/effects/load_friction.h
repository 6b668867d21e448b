#pragma once

#include "effects/effect.h"

namespace continuum {

inline constexpr std::array<std::string_view, 2> kLoadOptions{"transmitted", "actuator"};

/// Dry friction that grows with the load on the gear.
///
///   |τ_f| ≤ τ_c + μ_l · load        τ_c [N*m], μ_l [1]                (1)
///
/// load="transmitted": ½ |τ_actuator − τ_external|, the torque through the gear, alive with the
/// motor off; τ_external is gravity, springs and applied forces. load="actuator": |τ_actuator|.
/// Source: duclusaud2024.
struct LoadFriction {
  static constexpr std::string_view kName = "load_friction", kSource = "duclusaud2024",
                                    kSummary = "dry friction that grows with the load";
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr Joints kJoints = Joints::kHingeSlideBall;
  static constexpr std::array kParams{Magnitude("tau_c", "N*m", 0.01), Magnitude("mu_l", "1", 0.1)};
  static constexpr std::size_t kCoulombLevel = 0;
  static constexpr std::array kChoices{Choice{"load", kLoadOptions}};

  template <class T>
  static T Level(const FrictionState<T>& r, const Vec<T, 2>& p) {
    const auto& [tau_c, mu_l] = p;
    return tau_c + mu_l * r.load;  // (1)
  }
};

}  // namespace continuum
