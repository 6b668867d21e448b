#pragma once

#include "effects/effect.h"

namespace continuum {

/// Dry friction of a gear that transmits a load: the whole ladder of the extended friction models
/// of servo actuators (their M1 to M6), each rung a special case of the next.
///
///   |τ_f| ≤ τ_c + |μ_m τ_m − μ_e τ_e|
///           + s(v) (S_c + |s_m τ_m − s_e τ_e| + Q)                          (1)
///   s(v) = exp(−|v/v_d|^α)                                                  (2)
///   Q = q_e τ_e²  where τ_m and τ_e are opposed and |τ_m| > |τ_e|
///       q_m τ_m²  where they are opposed and |τ_m| < |τ_e|, else 0          (3)
///
/// τ_m [N*m] the actuators' torque on the joint · τ_e [N*m] that of all others but friction,
/// damping and inertia: gravity, springs, applied forces. τ_c, S_c [N*m] · μ_m, μ_e, s_m, s_e [1] ·
/// q_m, q_e [1/(N*m)] · v_d [rad/s] · α [1]. Where the motor drives, the load through the gear is
/// another one than where the load drives back: hence a weight for each. With α below 1 the excess
/// falls from the first motion on, and slowly after that: an XL330 asks for 0.4 to 0.8.
///
///   M1  τ_c (coulomb)        M2  and S_c, v_d, α      M3  τ_c and μ_m = μ_e (load_friction)
///   M4  M2, M3 and s_m = s_e   M5  all four weights free   M6  and q_m, q_e
///
/// give [rad] is the presliding: where it is not 0, the joint is held by a spring that reaches the
/// level after so far, and slips then (alone on its joint, not under the discrete integrator).
///
/// The load of load_friction is ½ |τ_m − τ_e|, so that its μ_l is 2 μ_m. The viscous part is the
/// joint's native damping. No candidate by itself: on one motion ten numbers fit what two explain.
/// A search leaves give and the four weights at 0: stribeck and load_friction are the rungs M2 and
/// M3, and what lies above them is the square of the load, whose excess has a speed and a shape.
/// Source: duclusaud2024.
struct GearFriction {
  static constexpr std::string_view kName = "gear_friction", kSource = "duclusaud2024",
                                    kSummary = "dry friction of a gear that transmits a load";
  static constexpr bool kReadsTorques = true, kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr std::array kParams{Magnitude("tau_c", "N*m", 0.01),
                                      Param{"mu_m", "1", 0, kInfinity, 0.05, 0, 0},
                                      Param{"mu_e", "1", 0, kInfinity, 0.05, 0, 0},
                                      Magnitude("S_c", "N*m", 0.01),
                                      Param{"s_m", "1", 0, kInfinity, 0.05, 0, 0},
                                      Param{"s_e", "1", 0, kInfinity, 0.05, 0, 0},
                                      Magnitude("q_m", "1/N/m", 0),
                                      Magnitude("q_e", "1/N/m", 0),
                                      Positive("v_d", "rad/s", 0.2),
                                      Param{"alpha", "1", 0.2, 10, 1.35, kAsIs},
                                      Param{"give", "rad", 0, kInfinity, 0, 0, 0}};
  static constexpr std::size_t kCoulombLevel = 0, kGive = 10;

  template <class T>
  static T Level(const FrictionState<T>& r, const Vec<T, 11>& p) {
    const auto& [tau_c, mu_m, mu_e, S_c, s_m, s_e, q_m, q_e, v_d, alpha, give] = p;
    const T speed = abs(r.v) / v_d;
    const T slow = speed > 0.0 ? T(exp(-exp(alpha * log(speed)))) : T(1);  // (2)
    T more(0);                                                             // (3)
    if (r.motor * r.others < 0.0) {
      const bool drives = abs(r.motor) > abs(r.others);
      more = drives ? T(q_e * r.others * r.others) : T(q_m * r.motor * r.motor);
    }
    return tau_c + abs(mu_m * r.motor - mu_e * r.others) +
           slow * (S_c + abs(s_m * r.motor - s_e * r.others) + more);  // (1)
  }
};

}  // namespace continuum
