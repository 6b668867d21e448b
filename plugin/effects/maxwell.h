#pragma once

#include "effects/effect.h"

namespace continuum {

/// Maxwell element: creep under load and relaxation when held. A spring in series with a damper.
///
///   ė = v − e/τ_m                e [rad]  stretch of the spring           (1)
///   τ = k_m e                    [N*m]                                    (2)
///   ψ = ½ k_m e²                 stored; loss k_m e²/τ_m ≥ 0 [W]          (3)
///
/// k_m [N*m/rad] spring · τ_m [s] relaxation time; the damper is c = k_m τ_m. Slow motion meets a
/// damper c, fast motion a spring k_m. With the joint's native spring in parallel it is the
/// standard linear solid. Source: maxwell1867.
struct Maxwell {
  static constexpr std::string_view kName = "maxwell", kSource = "maxwell1867",
                                    kSummary = "creep and relaxation";
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr Units kPort{"rad", "N*m"};
  static constexpr std::array kStates{State{"e", "rad"}};
  static constexpr std::array kParams{Magnitude("k_m", "N*m/rad", 0.1), Positive("tau_m", "s", 1)};

  template <class T>
  static Reply<T, 1> Eval(const Port<T>& q, const Vec<T, 1>& s, const Vec<T, 2>& p) {
    const auto& [e] = s;
    const auto& [k_m, tau_m] = p;
    return {k_m * e, {q.v - e / tau_m}, 0.5 * k_m * e * e};  // (2), (1), (3)
  }

  /// (1) at constant v: e relaxes to v τ_m within τ_m.
  template <class T>
  static Vec<T, 1> Step(const Vec<T, 1>& s, const Port<T>& q, double h, const Vec<T, 2>& p) {
    const auto& [e] = s;
    const auto& [k_m, tau_m] = p;
    const T steady = q.v * tau_m;
    return {steady + (e - steady) * exp(-h / tau_m)};
  }
};

}  // namespace continuum
