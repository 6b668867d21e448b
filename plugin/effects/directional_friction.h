#pragma once

#include "effects/effect.h"

namespace continuum {

/// Friction that depends on the direction: worm gears, preloaded seals, tendons with one bent end.
///
///   |τ_f| ≤ τ_c± + b± |v|        + where it moves or is pushed toward +q      (1)
///
/// which is a friction of one level beside a constant torque,
///
///   |τ_f − τ_0| ≤ (τ_c+ + τ_c−)/2 + b± |v|,   τ_0 = (τ_c− − τ_c+)/2           (2)
///
/// so that it holds against either side without knowing which one is to come.
/// tau_c_plus, tau_c_minus [N*m] · b_plus, b_minus [N*m*s/rad]. At rest a joint breaks away at
/// τ_c+ toward +q and at τ_c− toward −q. Beside the joint's native damping, if that is unknown,
/// only b_plus − b_minus can be determined. Joints of one direction: a ball joint has no +q and no
/// −q. Source: armstrong1994.
struct DirectionalFriction {
  static constexpr std::string_view kName = "directional_friction", kSource = "armstrong1994",
                                    kSummary = "friction that differs with the direction";
  static constexpr Kinship kKin{kDryFriction, 1};
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr std::array kParams{Magnitude("tau_c_plus", "N*m", 0.01),
                                      Magnitude("tau_c_minus", "N*m", 0.01),
                                      SpareDamping("b_plus", 0), SpareDamping("b_minus", 0)};

  template <class T>
  static T Level(const FrictionState<T>& r, const Vec<T, 4>& p) {
    const auto& [tau_c_plus, tau_c_minus, b_plus, b_minus] = p;
    const T mean = 0.5 * (tau_c_plus + tau_c_minus);
    return r.v > 0.0 ? T(mean + b_plus * r.v) : T(mean - b_minus * r.v);  // (2)
  }

  template <class T>
  static T Bias(const Vec<T, 4>& p) {
    const auto& [tau_c_plus, tau_c_minus, b_plus, b_minus] = p;
    return 0.5 * (tau_c_minus - tau_c_plus);  // τ_0
  }
};

}  // namespace continuum
