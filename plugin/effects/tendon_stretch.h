#pragma once

#include "effects/effect.h"

namespace continuum {

/// A cable that gets longer under tension, between a position servo and the robot.
///
///   T = T_0 − k c T,  so  T = T_0/(1 + k c)        T_0 ≥ 0                (1)
///
/// compliance c [m/N] of the whole cable · k [N/m] stiffness of the servos along the tendon · T_0
/// what they would give at zero stretch: they see their own end, c T short of the robot's. Exact at
/// rest; the servo's damping is softened in the same proportion. A cable that is pulled by a given
/// force (k = 0) transmits it whatever its stretch. Source: camarillo2008.
struct TendonStretch {
  static constexpr std::string_view kName = "tendon_stretch", kSource = "camarillo2008",
                                    kSummary = "a cable that gets longer under tension";
  static constexpr std::array kPlaces{Place::kTendon};
  static constexpr Tap kTap = Tap::kTendon;
  static constexpr std::array kParams{Magnitude("compliance", "m/N", 1e-4)};

  template <class T>
  static T Eval(const Pull<T>& pull, const Vec<T, 1>& p) {
    const auto& [c] = p;
    return pull.tension > 0.0 ? T(pull.tension / (1.0 + pull.stiffness * c)) : pull.tension;  // (1)
  }
};

}  // namespace continuum
