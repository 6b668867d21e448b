#pragma once

#include "effects/effect.h"

namespace continuum {

/// Dry friction that changes as the machine runs: grease that warms, a seal that settles, a gear
/// that runs in.
///
///   |τ_f| ≤ max(0, τ_c + Δ exp(−r_t t − r_W W))                             (1)
///   Ẇ = |τ_f v|      W [J] what dry friction has dissipated on the joint    (2)
///
/// τ_c [N*m] in the end · Δ = delta [N*m] more (or less) at the beginning · r_t [1/s] by time t,
/// from the beginning of the log · r_W [1/J] by work. Without rates τ_c and Δ say the same. No
/// candidate by itself: of two trials it explains what any difference between them does. Source:
/// bittencourt2012.
struct FrictionDrift {
  static constexpr std::string_view kName = "friction_drift", kSource = "bittencourt2012",
                                    kSummary = "dry friction that changes as the machine runs";
  static constexpr bool kReadsWork = true, kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr std::array kParams{Magnitude("tau_c", "N*m", 0.01),
                                      Signed("delta", "N*m", 0.005), Magnitude("r_t", "1/s", 0.1),
                                      Param{"r_W", "1/J", 0, kInfinity, 0, 0, 0}};
  static constexpr std::size_t kCoulombLevel = 0;

  template <class T>
  static T Level(const FrictionState<T>& r, const Vec<T, 4>& p) {
    const auto& [tau_c, delta, r_t, r_W] = p;
    const T level = tau_c + delta * exp(-r_t * r.time - r_W * r.work);
    return level > 0.0 ? level : T(0);  // (1)
  }
};

}  // namespace continuum
