#pragma once

#include <vector>

#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// Shape of the module under pressures p and loads: a rod of variable curvature (48-50).
///
///   rho' = R (xi + e_y),  R' = R [zeta]x,  M' = -rho' x F(s)
///   F(s) = f + m_fs g + m g (1 - s/l),  M(l) = t x l_fs (f + m_fs g/2),  t = R e_y
///   xi = (n_x/(G a_d), lambda - 1, n_z/(G a_d)),  n = R^T F,  zeta_y = M_y/(G J_p)
///
/// lambda, zeta_x, zeta_z from the law of the section (elastic.h). Shooting: Newton on the three
/// components of M(0), derivatives by dual numbers through an integrator of eighth order whose
/// steps are halved until tip and moment move by less than 1e-10. Loads far below buckling leave
/// one equilibrium; others are raised together (statics::FollowRisingLoad). A saddle is never an
/// answer.
///
/// line: filled with points of the axis from base to tip, for pictures; empty without an answer.
Solution SolveForward(const Module& module, const Method& method, const Case& row, bool sensitivity,
                      std::vector<Eigen::Vector3d>* line = nullptr);

/// The equilibrium next to the one with base moment M(0) [E J_0/l], stable or not.
Solution SolveNear(const Module& module, const Method& method, const Case& row,
                   const Eigen::Vector3d& moment);

/// The line of SolveForward alone.
std::vector<Eigen::Vector3d> ForwardLine(const Module& module, const Method& method,
                                         const Case& row);

/// M(0) [N m] of the answer; NaN when the case has none.
Eigen::Vector3d BaseMoment(const Module& module, const Method& method, const Case& row);

}  // namespace continuum::stiff_flop
