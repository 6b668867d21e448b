#pragma once

#include "effects/effect.h"
#include "effects/pcc_kinematics.h"

namespace continuum {

/// Soft segment of constant curvature: three pressure chambers against an elastic body.
///
///   F = τ(δ, p) − k(δ) − d(δ̇)                             F [N] on δ = (Δx, Δy, δL) [m]     (1)
///   k = (k_theta Δx + k_theta3 Δx³, same in Δy, k_dL1 δL + k_dL3 δL³)                       (2)
///   d = (d_theta Δẋ, d_theta Δẏ, d_dL δL̇)                                                   (3)
///   τ = PccTipForces or PccVolumeForces of the load                                          (4)
///   f_z = A Σ p_i, m_x = A Σ r_iy p_i, m_y = −A Σ r_ix p_i                                  (5)
///
/// Δx = d u and Δy = d v for a tip that is bent by u [rad] toward +x and v toward +y; p [Pa] gauge
/// pressures. actuation="tip" is the source's: the load on the tip, its opposite on the base;
/// "volume" also counts the pressure on the side walls of the bent chambers, Σ p_i ∂V_i/∂δ. Chamber
/// 1 lies at −x, chambers 2 and 3 at ±2π/3 from it, at the radius r_ch about a centre that is off
/// by −(x_m, y_m): p_1 bends toward +x. k_dL3 < 0 softens: beyond δL = √(−k_dL1/(3 k_dL3)) nothing
/// holds the segment. Only d takes energy, k stores it, τ brings it.
///
/// The other two parameters of the source's table are MuJoCo's own: T_PT1, the lag of a chamber
/// behind its supply, is the actuator's dyntype="filterexact" dynprm="T_PT1"; the mass m is that of
/// the links, in all and at their places.
///
/// Source: spa2022, eqs. 12-15 and 21-26; signs of (5) from r × f with f along +z.
struct PccSegmentLaw {
  static constexpr std::string_view kName = "pcc_segment", kSource = "spa2022",
                                    kSummary = "soft segment with three pressure chambers";
  static constexpr std::array kPlaces{Place::kBody, Place::kActuator};
  static constexpr std::array kParams{Positive("L0", "m", 0.13),
                                      Positive("d", "m", 0.05),
                                      Positive("r_ch", "m", 0.03),
                                      Signed("x_m", "m", -0.4e-3),
                                      Signed("y_m", "m", -1.5e-3),
                                      Magnitude("A", "m^2", 31e-6),
                                      Magnitude("d_theta", "kg/s", 0.2301),
                                      Magnitude("d_dL", "kg/s", 1.8384),
                                      Magnitude("k_theta", "N/m", 183.5195),
                                      Signed("k_theta3", "N/m^3", 0),
                                      Magnitude("k_dL1", "N/m", 251.7274),
                                      Signed("k_dL3", "N/m^3", -4.2e4)};
  static constexpr std::size_t kRestLength = 0, kArcRadius = 1;
  static constexpr std::string_view kActuations[] = {"tip", "volume"};
  static constexpr std::array kChoices{Choice{"actuation", kActuations}};
  template <class T>
  using Params = ParamsOf<PccSegmentLaw, T>;

  template <class T>
  static Vec<T, 3> Eval(const Vec<T, 3>& delta, const Vec<T, 3>& rate, const Vec<T, 3>& pressure,
                        int actuation, const Params<T>& p) {
    const Vec<T, 3> drive = Drive(delta, pressure, actuation, p);
    const Vec<T, 3> body = Material(delta, rate, p);
    return {drive[0] - body[0], drive[1] - body[1], drive[2] - body[2]};
  }

  /// (4).
  template <class T>
  static Vec<T, 3> Drive(const Vec<T, 3>& delta, const Vec<T, 3>& pressure, int actuation,
                         const Params<T>& p) {
    const PccLoad<T> load = PccPressureLoad(Chambers(p), pressure);
    return actuation == 0 ? PccTipForces(Segment(p), delta, load)
                          : PccVolumeForces(Segment(p), load);
  }

  /// (2) + (3).
  template <class T>
  static Vec<T, 3> Material(const Vec<T, 3>& delta, const Vec<T, 3>& rate, const Params<T>& p) {
    const auto& [L0, d, r_ch, x_m, y_m, A, d_theta, d_dL, k_theta, k_theta3, k_dL1, k_dL3] = p;
    const auto& [x, y, l] = delta;
    return {x * (k_theta + k_theta3 * x * x) + d_theta * rate[0],
            y * (k_theta + k_theta3 * y * y) + d_theta * rate[1],
            l * (k_dL1 + k_dL3 * l * l) + d_dL * rate[2]};
  }

  template <class T>
  static PccSegment<T> Segment(const Params<T>& p) {
    return {p[0], p[1]};
  }
  template <class T>
  static PccChambers<T> Chambers(const Params<T>& p) {
    return {p[2], p[3], p[4], p[5]};
  }
};

}  // namespace continuum
