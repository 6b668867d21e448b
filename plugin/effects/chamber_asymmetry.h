#pragma once

#include "effects/effect.h"
#include "effects/pcc_kinematics.h"

namespace continuum {

/// Three chambers whose centre is not on the axis of their segment. It acts beside a pcc_segment
/// and adds (x_m, y_m) to that law's own centre:
///
///   r_i → r_i − (x_m, y_m):  f_z += 0,  m_x −= A y_m Σ p_i,  m_y += A x_m Σ p_i               (1)
///   F = PccTipForces or PccVolumeForces of (1)                     [N] on (Δx, Δy, δL)        (2)
///
/// Equal pressures bend the segment toward (x_m, y_m) [m]. p_i [Pa] gauge pressures, A [m²] and
/// d [m] those of the segment; actuation too. Both laws are linear in the load, so that the sum of
/// the two instances is the segment with its centre moved.
///
/// Source: spa2022, eqs. 21-26.
struct ChamberAsymmetry {
  static constexpr std::string_view kName = "chamber_asymmetry", kSource = "spa2022",
                                    kSummary = "chambers off the axis of their soft segment";
  static constexpr std::array kPlaces{Place::kBody, Place::kActuator};
  static constexpr std::array kParams{Positive("d", "m", 0.05), Positive("A", "m^2", 31e-6),
                                      Signed("x_m", "m", 1e-4), Signed("y_m", "m", 1e-4)};
  static constexpr std::size_t kArcRadius = 0;
  static constexpr std::string_view kActuations[] = {"tip", "volume"};
  static constexpr std::array kChoices{Choice{"actuation", kActuations}};
  template <class T>
  using Params = ParamsOf<ChamberAsymmetry, T>;

  template <class T>
  static Vec<T, 3> Eval(const Vec<T, 3>& delta, const Vec<T, 3>&, const Vec<T, 3>& pressure,
                        int actuation, const Params<T>& p) {
    const auto& [d, A, x_m, y_m] = p;
    const T push = A * (pressure[0] + pressure[1] + pressure[2]);
    const PccLoad<T> load{T(0.0), -y_m * push, x_m * push};  // (1)
    return actuation == 0 ? PccTipForces(Segment(p), delta, load)
                          : PccVolumeForces(Segment(p), load);
  }

  /// Without a force along the tip the length does not matter.
  template <class T>
  static PccSegment<T> Segment(const Params<T>& p) {
    return {p[0], p[0]};
  }
};

}  // namespace continuum
