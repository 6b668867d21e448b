#pragma once

#include "effects/effect.h"

namespace continuum {

/// Dry friction that varies over one turn: a bent shaft, an eccentric gear.
///
///   |τ_f| ≤ max(0, τ_c + c cos q + s sin q)      τ_c, c, s [N*m]      (1)
///
/// Joints of one coordinate q: what a ball joint's would be is not defined. Source: armstrong1994.
struct PositionFriction {
  static constexpr std::string_view kName = "position_friction", kSource = "armstrong1994",
                                    kSummary = "dry friction that varies with the joint's angle";
  static constexpr Kinship kKin{kDryFriction, 1};
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr std::array kParams{Magnitude("tau_c", "N*m", 0.01), Signed("c", "N*m", 0),
                                      Signed("s", "N*m", 0)};
  static constexpr std::size_t kCoulombLevel = 0;

  template <class T>
  static T Level(const FrictionState<T>& r, const Vec<T, 3>& p) {
    const auto& [tau_c, c, s] = p;
    const T level = tau_c + c * cos(r.q) + s * sin(r.q);
    return level > 0.0 ? level : T(0);  // (1)
  }
};

}  // namespace continuum
