#pragma once

#include "effects/effect.h"

namespace continuum {

/// A cable that is too long: a position servo first winds up its slack.
///
///   T = max(0, T_0 − k length)       T_0 ≥ 0                              (1)
///
/// length [m] of cable beyond that of the model · k [N/m] stiffness of the servos along the tendon
/// · T_0 what they would give on a tight cable. A cable that is pulled by a given force (k = 0) is
/// tight by itself. Source: camarillo2008.
struct Slack {
  static constexpr std::string_view kName = "slack", kSource = "camarillo2008",
                                    kSummary = "a cable that must be wound up before it pulls";
  static constexpr std::array kPlaces{Place::kTendon};
  static constexpr Tap kTap = Tap::kTendon;
  static constexpr std::array kParams{Magnitude("length", "m", 1e-3)};

  template <class T>
  static T Eval(const Pull<T>& pull, const Vec<T, 1>& p) {
    const auto& [length] = p;
    if (!(pull.tension > 0.0)) return pull.tension;
    const T rest = pull.tension - pull.stiffness * length;
    return rest > 0.0 ? rest : T(0);  // (1)
  }
};

}  // namespace continuum
