#pragma once

#include <cmath>

#include "effects/effect.h"

namespace continuum {

/// Viscous friction that differs with the direction: ball screws whose nut is preloaded to one
/// side, gears with flanks of unlike wear, dampers with a valve.
///
///   τ = b v + d |v| = (b ± d) v     + where v > 0                              (1)
///
/// τ [N*m] torque on the effect · v [rad/s] · b, d [N*m*s/rad] mean, added to the native damping
/// b_0 of the joint, and half the difference. It only takes energy where |d| ≤ b + b_0. A search
/// leaves b to b_0. Joints of one direction. Source: armstrong1994.
struct DirectionalViscous {
  static constexpr std::string_view kName = "directional_viscous", kSource = "armstrong1994",
                                    kSummary = "viscous friction that differs with the direction";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array<State, 0> kStates{};
  static constexpr std::array kParams{SpareDamping("b", 0.1), Signed("d", "N*m*s/rad", 0.01)};

  /// The damping [N*m*s/rad] that a joint must have of its own, lest the law creates energy.
  static double LeastDamping(const Vec<double, 2>& p) { return std::abs(p[1]) - p[0]; }

  template <class T>
  static Reply<T, 0> Eval(const Port<T>& q, const Vec<T, 0>&, const Vec<T, 2>& p) {
    const auto& [b, d] = p;
    return {b * q.v + d * abs(q.v), {}, T(0)};  // (1)
  }
  template <class T>
  static Vec<T, 0> Step(const Vec<T, 0>& z, const Port<T>&, double, const Vec<T, 2>&) {
    return z;
  }
};

}  // namespace continuum
