#pragma once

#include "effects/effect.h"
#include "effects/pcc_kinematics.h"

namespace continuum {

/// Gas section of a braided tube over that at rest. The thread of lead angle γ from the tube's axis
/// keeps its length: the radius x r_c and the stretch λ obey
///
///   (x sin γ)² + (λ cos γ)² = 1,  so  x² = 1 + cot²γ (1 − λ²)                                (1)
///
/// Source: sadati2017, eq. 12. γ = π/2 are rings, x = 1.
template <class T>
T BraidSection(const T& cot2_gamma, const T& lambda2) {
  return 1.0 + cot2_gamma * (1.0 - lambda2);
}

/// What a braid changes of the force of a segment's chambers: as they lengthen they become thinner.
/// It acts beside a pcc_segment with actuation="volume", whose chambers keep their section.
///
///   ℓ_i = L0 + δL − (r_ix Δx + r_iy Δy)/d,  λ_i = ℓ_i/L0        length of chamber i         (2)
///   V_i = A ℓ_i (1 + cot²γ (1 − λ_i²))                           its gas, by (1)             (3)
///   F = Σ p_i ∂(V_i − A ℓ_i)/∂δ = Σ p_i A cot²γ (1 − 3 λ_i²) ∂ℓ_i/∂δ                         (4)
///
/// F [N] on δ = (Δx, Δy, δL) [m], p_i [Pa] gauge pressures, A [m²] gas section of a line at rest.
/// Volume law and (4) together push with p A (1 − 3 cos²γ_e)/sin²γ, cos γ_e = λ cos γ: the force of
/// chou1996 with its sign, none at γ_e = 54.7°. Work of the gas: nothing is stored or lost. L0, d,
/// r_ch, x_m, y_m and A are those of the segment. Exact where the tube bends as a whole; how its
/// section varies around the bend is left out (eqs. 25-29).
///
/// Source: sadati2017, eqs. 5, 12, 13.
struct Braid {
  static constexpr std::string_view kName = "braid", kSource = "sadati2017",
                                    kSummary = "chambers that a braid narrows as they lengthen";
  static constexpr std::array kPlaces{Place::kBody, Place::kActuator};
  static constexpr std::array kParams{Positive("L0", "m", 0.044),
                                      Positive("d", "m", 0.0125),
                                      Positive("r_ch", "m", 0.0085),
                                      Param{"x_m", "m", -kInfinity, kInfinity, 0, kAsIs},
                                      Param{"y_m", "m", -kInfinity, kInfinity, 0, kAsIs},
                                      Positive("A", "m^2", 39.3e-6),
                                      Magnitude("cot2_gamma", "1", 0.03)};
  static constexpr std::size_t kRestLength = 0, kArcRadius = 1;
  template <class T>
  using Params = ParamsOf<Braid, T>;

  /// The rates and the choice are those of every segment law; the gas knows neither.
  template <class T>
  static Vec<T, 3> Eval(const Vec<T, 3>& delta, const Vec<T, 3>&, const Vec<T, 3>& pressure, int,
                        const Params<T>& p) {
    const auto& [L0, d, r_ch, x_m, y_m, A, cot2_gamma] = p;
    const PccChambers<T> chambers{r_ch, x_m, y_m, A};
    Vec<T, 3> force{T(0.0), T(0.0), T(0.0)};
    for (int i = 0; i < 3; ++i) {
      const auto [x, y] = PccChamber(chambers, i);
      const Vec<T, 3> slope{-x / d, -y / d, T(1.0)};  // ∂ℓ_i/∂δ
      T stretch(1.0);
      for (int j = 0; j < 3; ++j) stretch = stretch + slope[j] * delta[j] / L0;
      const T push = pressure[i] * A * cot2_gamma * (1.0 - 3.0 * stretch * stretch);
      for (int j = 0; j < 3; ++j) force[j] = force[j] + push * slope[j];
    }
    return force;
  }

  template <class T>
  static PccSegment<T> Segment(const Params<T>& p) {
    return {p[0], p[1]};
  }
};

}  // namespace continuum
