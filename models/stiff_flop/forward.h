#pragma once

#include <vector>

#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// Shape of modules in series under pressures p and loads: rods of variable curvature (48-50).
///
///   rho' = R (xi + e_y),  R' = R [zeta]x,  M' = -rho' x F(s)
///   F(s) = F_j + m_j g (1 - s/l_j),  F_j = f + m_fs,j g + Sum_k>j (m_k + m_fs,k) g
///   M(l_j) = M_j+1(0) + t x l_fs,j (F_j - m_fs,j g/2),  t = R e_y
///
/// on module j = 1..K; the last one ends with M_K+1 = 0. Mounts are rigid: the next module begins
/// at rho + l_fs t with the same R.
///   xi = (n_x/(G a_d), lambda - 1, n_z/(G a_d)),  n = R^T F,  zeta_y = M_y/(G J_p)
///
/// lambda, zeta_x, zeta_z from the law of the section (elastic.h). Shooting: Newton on the three
/// components of M(0), derivatives by dual numbers through an integrator of eighth order whose
/// steps are halved until tip and moment move by less than 1e-10. Loads far below buckling leave
/// one equilibrium; others are raised together (statics::FollowRisingLoad). A saddle is never an
/// answer.
/// Sensitivities are by gamma and E of all modules at once.
Solution SolveForward(const ModuleSeries& series, const Method& method, const Case& row,
                      bool sensitivity);

/// The equilibrium next to the one with base moment M(0) [ModuleSeries::unit()], stable or not.
Solution SolveNear(const ModuleSeries& series, const Method& method, const Case& row,
                   const Eigen::Vector3d& moment);

/// Points of the axis of every module of an answer, for pictures; nothing where there is none.
std::vector<std::vector<Eigen::Vector3d>> LinesOf(const ModuleSeries& series, const Method& method,
                                                  const Case& row, const Solution& solution);

/// All of them, of the answer of a case.
std::vector<Eigen::Vector3d> ForwardLine(const ModuleSeries& series, const Method& method,
                                         const Case& row);

/// M(0) [N m] of the answer; NaN when the case has none.
Eigen::Vector3d BaseMoment(const ModuleSeries& series, const Method& method, const Case& row);

}  // namespace continuum::stiff_flop
