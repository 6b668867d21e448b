#pragma once

#include "effects/effect.h"

namespace continuum {

/// Free play between a position servo and its joint.
///
///   force = k_p dz(u − q),   dz(e) = e − clamp(e, −gap/2, gap/2)          (1)
///
/// gap [rad] is the total free play. The servo's own damping term is unchanged.
/// Source: nordin2002.
struct Backlash {
  static constexpr std::string_view kName = "backlash", kSource = "nordin2002",
                                    kSummary = "free play between a servo and its joint";
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr Tap kTap = Tap::kServoError;
  static constexpr std::array kParams{Magnitude("gap", "rad", 0.02)};

  template <class T>
  static T Eval(const T& e, const Vec<T, 1>& p) {
    const T half = 0.5 * p[0];
    if (e > half) return e - half;  // (1)
    if (e < -half) return e + half;
    return T(0);
  }
};

}  // namespace continuum
