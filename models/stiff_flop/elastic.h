#pragma once

#include "models/stiff_flop/tubes.h"

namespace continuum::stiff_flop {

/// Hooke's law of one deformed section: which internal force and moments its strains need.
///
/// With F_i = p_i n_c a_Gi, tubes at r_od in direction m_i = (sin psi_i, cos psi_i), and
/// (zeta_x, zeta_z) = -lambda (k_2, k_1), all in the local frame:
///
/// (1) n_y = E a_d (lambda - 1) - Sum F_i,         a_d = a_b - Sum n_c a_Gi
/// (2) (M_x, M_z) = E K (zeta_x, zeta_z) - Sum F_i r_od m_i,
///     K = (J_b - Sum j_i) I - Sum n_c a_Gi r_od² m_i m_i^T,  j_i = n_c a_Gi²/(4 pi)
/// (3) J_p = J_b + Int z*² da* - Sum (2 j_i + n_c a_Gi r_od²) for the twist, M_y = G J_p zeta_y
template <class T>
struct Reaction {
  T n_y, M_x, M_z;  ///< [N], [N m]
  T area;           ///< a_d [m²]
  T polar;          ///< J_p [m⁴]
};

template <class T>
Reaction<T> ReactionOf(const Module& module, const Method& method, const Eigen::VectorXd& p,
                       const T& E, const T& gamma, const Axis<T>& axis) {
  const Body<T> body(method.body, axis.bend());
  Section<T> section = body.Deformed(module.r_2);
  if (module.r_1 > 0) {
    const Section<T> hole = body.Deformed(module.r_1);
    section = {section.area - hole.area, section.x2 - hole.x2, section.z2 - hole.z2};
  }
  const T zeta_x = -axis.lambda * axis.k_2;
  const T zeta_z = -axis.lambda * axis.k_1;
  const T r_od = TubeDistance(module, method.body, axis.lambda);
  Reaction<T> reaction{T(0.0), T(0.0), T(0.0), section.area, section.x2 + section.z2};
  T bending = section.x2;
  for (std::size_t i = 0; i < module.lines.size(); ++i) {
    const Bend<T> bend = TubeBend(module, axis, r_od, i);
    const T gas =
        static_cast<double>(module.n_c) * Tube(module, method.chamber, gamma, bend).GasArea();
    // n_c bores of area gas/n_c each.
    const T own = gas * gas / (4 * std::numbers::pi * module.n_c);
    const T thrust = p[static_cast<Eigen::Index>(i)] * gas;
    const T m_x(module.lines[i][1]);
    const T m_z(module.lines[i][0]);
    const T missing = E * gas * r_od * r_od * (m_x * zeta_x + m_z * zeta_z);
    reaction.n_y -= thrust;
    reaction.M_x -= m_x * (missing + thrust * r_od);
    reaction.M_z -= m_z * (missing + thrust * r_od);
    reaction.area -= gas;
    reaction.polar -= 2.0 * own + gas * r_od * r_od;
    bending -= own;
  }
  reaction.n_y += E * reaction.area * (axis.lambda - 1.0);
  reaction.M_x += E * bending * zeta_x;
  reaction.M_z += E * bending * zeta_z;
  return reaction;
}

}  // namespace continuum::stiff_flop
