#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>

namespace continuum {

/// The last degree of freedom that moves a body, −1: none; dof_parentid leads on to the root.
inline int LastDof(const mjModel& m, int body) {
  while (body > 0 && m.body_dofnum[body] == 0) body = m.body_parentid[body];
  return body > 0 ? m.body_dofadr[body] + m.body_dofnum[body] - 1 : -1;
}

/// ∂p/∂q of a point [m] that moves with a degree of freedom of a hinge or slide, where d knows the
/// axes (mj_comPos).
inline Eigen::Vector3d PointJacobian(const mjModel& m, const mjData& d, int dof,
                                     const Eigen::Vector3d& point) {
  const double* const axis = d.cdof + 6 * dof;  // turn and shift about the tree's centre of mass
  const Eigen::Vector3d centre(d.subtree_com + 3 * m.body_rootid[m.dof_bodyid[dof]]);
  return Eigen::Vector3d(axis + 3) + Eigen::Vector3d(axis).cross(point - centre);
}

}  // namespace continuum
