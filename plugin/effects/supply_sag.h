#pragma once

#include "effects/effect.h"

namespace continuum {

/// A supply whose voltage falls under load: a battery, a long cable, a small adapter. What all
/// motors on it draw takes from each of them, full output above all.
///
///   V/V_0 = 1 − r Σ_j |F_j|        r = R_s/(k V_0)                        (1)
///   F_i = u_i V/V_0                                                       (2)
///   F_i = u_i/(1 + r Σ_j |u_j|)    from both                              (3)
///
/// V [V] voltage of the supply, V_0 at no load, R_s [Ω] its resistance · F_i [N*m] force of each
/// actuator before its gear, for which it draws |F_i|/k · k [N*m/A] of its motor · u_i [N*m] what
/// it would give at V_0, within its range: a share of V drives it (2). On a tendon or a slide joint
/// read N for N*m. r [1/(N*m)], 0 on a stiff supply; as it grows, all of them together never give
/// more than 1/r. Braking draws as driving does. An actuator with range L gives L/(1 + r L) alone.
///
/// One instance is one supply, of motors with one k. No candidate by itself: where torques stay
/// small, or all of one size, it says what a smaller gain does. Source: plett2015.
struct SupplySag {
  static constexpr std::string_view kName = "supply_sag", kSource = "plett2015",
                                    kSummary = "a supply whose voltage falls under load";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr Tap kTap = Tap::kSupply;
  static constexpr std::array kParams{Magnitude("r", "1/N/m", 0.1)};

  template <class T>
  static T Share(const T& load, const Vec<T, 1>& p) {
    return 1.0 / (1.0 + p[0] * load);  // (3)
  }
};

}  // namespace continuum
