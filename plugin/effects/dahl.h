#pragma once

#include "effects/effect.h"

namespace continuum {

/// Dahl friction: presliding hysteresis of a tendon in its sheath, of a joint's grease.
///
///   ż = (σ/f) (v − |v| z)       z [1]  presliding, |z| ≤ 1                (1)
///   F = f·z                     F [N*m]  drag                             (2)
///   ψ = ½·f²/σ·z²               ψ [J]  stored; loss f |v| z² ≥ 0 [W]      (3)
///
/// σ [N*m/rad] stiffness at reversal · f [N*m] sliding torque. Written with z = F/f, so that f = 0
/// is the smooth null. Rate-independent, no breakaway peak. Source: dahl1968, first-order form.
struct Dahl {
  static constexpr std::string_view kName = "dahl", kSource = "dahl1968",
                                    kSummary = "friction with elastic presliding (hysteresis)";
  static constexpr Kinship kKin{kDryFriction, 1};
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array kStates{State{"z", "1"}};
  static constexpr std::array kParams{Positive("sigma", "N*m/rad", 1), Magnitude("f", "N*m", 0.01)};

  template <class T>
  static Reply<T, 1> Eval(const Port<T>& q, const Vec<T, 1>& s, const Vec<T, 2>& p) {
    const auto& [z] = s;
    const auto& [sigma, f] = p;
    const T rate = f > 0.0 ? T(sigma / f * (q.v - abs(q.v) * z)) : T(0);  // (1)
    return {f * z, {rate}, 0.5 * f * f / sigma * z * z};                  // (2), (3)
  }

  /// (1) at constant v: z decays to sgn(v) over the path f/σ.
  template <class T>
  static Vec<T, 1> Step(const Vec<T, 1>& s, const Port<T>& q, double h, const Vec<T, 2>& p) {
    const auto& [z] = s;
    const auto& [sigma, f] = p;
    if (q.v == 0.0) return s;
    const double end = q.v > 0.0 ? 1 : -1;
    if (!(f > 0.0)) return {T(end)};
    return {end + (z - end) * exp(-sigma / f * abs(q.v) * h)};
  }
};

}  // namespace continuum
