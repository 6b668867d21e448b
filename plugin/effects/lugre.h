#pragma once

#include "effects/effect.h"

namespace continuum {

/// LuGre friction: bristles that bend before they slip, with the Stribeck effect.
///
///   ż = (σ_0/τ_c) (v − |v| z/s(v)),   s(v) = 1 + S exp(−(v/v_s)²)         (1)
///   τ = τ_c z + σ_1(v) (τ_c/σ_0) ż,   σ_1(v) = σ_1 exp(−(v/v_s)²)         (2)
///   ψ = ½ τ_c²/σ_0 z²                                                     (3)
///
/// z [1] torque of the bristles over τ_c · σ_0 [N*m/rad] their stiffness · σ_1 [N*m*s/rad] their
/// damping · τ_c [N*m] sliding, τ_c (1 + S) breakaway level · v_s [rad/s]. In the symbols of the
/// source: bristle z τ_c/σ_0, g(v) = τ_c s(v). Written with z so that τ_c = 0 is the smooth null.
/// σ_1 fades with speed (olsson1998), which keeps the law passive where 0.43 σ_1 v_s ≤ 4 τ_c. The
/// viscous term σ_2 v is the joint's native damping (effect viscous). The engine adds the torque
/// explicitly: with M the joint's inertia it wants h² σ_0 < 4 M and h σ_1 < 2 M.
/// Source: canudas1995.
struct Lugre {
  static constexpr std::string_view kName = "lugre", kSource = "canudas1995",
                                    kSummary = "dry friction with presliding and breakaway";
  static constexpr Kinship kKin{kDryFriction, 1};
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array kStates{State{"z", "1"}};
  static constexpr std::array kParams{Positive("sigma_0", "N*m/rad", 1), SpareDamping("sigma_1", 0),
                                      Magnitude("tau_c", "N*m", 0.01), Magnitude("S", "1", 0.5),
                                      Positive("v_s", "rad/s", 0.1)};

  template <class T>
  static Reply<T, 1> Eval(const Port<T>& q, const Vec<T, 1>& state, const Vec<T, 5>& p) {
    const auto& [z] = state;
    const auto& [sigma_0, sigma_1, tau_c, S, v_s] = p;
    const T fade = exp(-(q.v / v_s) * (q.v / v_s));
    const T bend = q.v - abs(q.v) * z / (1.0 + S * fade);
    const T rate = tau_c > 0.0 ? T(sigma_0 / tau_c * bend) : T(0);  // (1)
    const T damped = tau_c > 0.0 ? T(sigma_1 * fade * bend) : T(0);
    return {tau_c * z + damped, {rate}, 0.5 * tau_c * tau_c / sigma_0 * z * z};  // (2), (3)
  }

  /// (1) at constant v: z decays to sgn(v) s(v) over the path s(v) τ_c/σ_0.
  template <class T>
  static Vec<T, 1> Step(const Vec<T, 1>& state, const Port<T>& q, double h, const Vec<T, 5>& p) {
    const auto& [z] = state;
    const auto& [sigma_0, sigma_1, tau_c, S, v_s] = p;
    if (q.v == 0.0) return state;
    const T level = 1.0 + S * exp(-(q.v / v_s) * (q.v / v_s));
    const T end = q.v > 0.0 ? level : T(-level);
    if (!(tau_c > 0.0)) return {end};
    return {end + (z - end) * exp(-sigma_0 / tau_c * abs(q.v) * h / level)};
  }
};

}  // namespace continuum
