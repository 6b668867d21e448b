#pragma once

#include "effects/effect.h"

namespace continuum {

/// Stribeck friction: dry friction that falls with speed, plus viscous friction.
///
///   τ_f = τ_μ v + sgn(v) τ_c (1 + S exp(−(v/v_d)²))                   (1)
///
/// τ_μ [N*m*s/rad] viscous · τ_c [N*m] Coulomb · S [1] excess at rest · v_d [rad/s] Stribeck speed.
/// τ_μ is the joint's native damping, which must be 0 or equal in the MJCF (τ_μ = 0 leaves it
/// alone); of several laws on one joint it is the sum. Breakaway is τ_c (1 + S). The print's
/// tanh(k_v v) in place of sgn(v) never sticks: it only serves to replay the paper's own curve
/// (Literal) and does not change the friction in a simulation. Source: snake_arm, eq. 7.
struct Stribeck {
  static constexpr std::string_view kName = "stribeck", kSource = "snake_arm",
                                    kSummary = "dry friction that is larger at rest, and viscous";
  static constexpr Kinship kKin{kDryFriction, 1};
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr Joints kJoints = Joints::kHingeSlideBall;
  static constexpr std::array kParams{SpareDamping("tau_mu", 0.01), Magnitude("tau_c", "N*m", 0.01),
                                      Magnitude("S", "1", 0.5), Positive("v_d", "rad/s", 0.3),
                                      Positive("k_v", "s/rad", 1000)};
  static constexpr std::size_t kDamping = 0, kCoulombLevel = 1, kLiteral = 4;

  template <class T>
  static T Level(const FrictionState<T>& r, const Vec<T, 5>& p) {
    const auto& [tau_mu, tau_c, S, v_d, k_v] = p;
    const T w = r.v / v_d;
    return tau_c * (1.0 + S * exp(-w * w));  // dry part of (1)
  }

  /// Equation 7 as printed, with tanh for the sign.
  template <class T>
  static T Literal(const T& v, const Vec<T, 5>& p) {
    const auto& [tau_mu, tau_c, S, v_d, k_v] = p;
    return tau_mu * v + tanh(k_v * v) * Level(FrictionState<T>{T(0), v, T(0)}, p);
  }
};

}  // namespace continuum
