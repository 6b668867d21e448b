#pragma once

#include "effects/effect.h"

namespace continuum {

inline constexpr std::array<std::string_view, 2> kCapstanOptions{"exponential", "coulomb"};

/// Capstan friction of a cable along its route. A contact with wrap angle θ that slides in the
/// direction s = ±1 (+1: pulled toward the actuator) hands on
///
///   T_i = T_{i−1} exp(−s μ(θ) θ)                       law="exponential"        (1)
///   T_i = T_{i−1} (1 − s t)/(1 + s t), t = μ tan(θ/2)  law="coulomb"            (2)
///   μ(θ) = mu + mu1 θ + mu2 θ²                                                  (3)
///
/// and one at rest holds any ratio in between: the one that keeps it at rest, with s the direction
/// at the end of the step (binding/cable_sliding.h). (2) is Coulomb friction on the normal force of
/// a sharp bend, (T_{i−1} − T_i) cos(θ/2) = μ (T_{i−1} + T_i) sin(θ/2). At t = 1 the bend locks:
/// what is pulled hands on nothing, and no load draws the cable out. The band ends there, at the
/// ratio 2·10⁶. Source: snake_arm, eq. 8 (1); eytelwein1808.
///
/// give [m] is the sliding over which the friction of a contact builds up, as cables and their
/// guides are elastic: from ρ = log(T_i/T_{i−1}) = 0 on, pulled by x, ρ = −μθ x/give until it
/// slides. Without it (0) that is what the solver needs, 1 mm/s times the step: 2 um at 2 ms. The
/// spring is as stiff as the tension says: tension that rises while a contact is deflected stores
/// energy in it. A few logs seldom show it, so a search leaves give at 0.
struct Capstan {
  static constexpr std::string_view kName = "capstan", kSource = "eytelwein1808",
                                    kSummary = "friction of a cable along its route";
  static constexpr std::array kPlaces{Place::kTendon};
  static constexpr std::array kParams{Param{"mu", "1", 0, 100, 0.1, 0}, Signed("mu1", "1/rad", 0),
                                      Signed("mu2", "1/rad^2", 0),
                                      Param{"give", "m", 0, kInfinity, 0, 0, 0}};
  static constexpr std::size_t kGive = 3;
  static constexpr std::array kChoices{Choice{"law", kCapstanOptions}};

  /// Largest |log(T_i/T_{i−1})| of a contact; law 0 is (1), law 1 is (2).
  template <class T>
  static T Band(const T& theta, int law, const Vec<T, 4>& p) {
    const auto& [mu, mu1, mu2, give] = p;
    const T friction = mu + theta * (mu1 + theta * mu2);  // (3)
    if (!(friction > 0.0)) return T(0);
    if (law == 0) return friction * theta;  // (1)
    const T t = friction * tan(0.5 * theta);
    const double locked = 0.999999;
    return t < locked ? T(log((1.0 + t) / (1.0 - t))) : T(std::log((1 + locked) / (1 - locked)));
  }
};

}  // namespace continuum
