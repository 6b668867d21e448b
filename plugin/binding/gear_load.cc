#include "binding/gear_load.h"

#include <algorithm>
#include <cmath>

#include "binding/actuator_force.h"

namespace continuum {
namespace {

// By the actuators, within their ranges and that of the joint.
double ActuatorTorque(const mjModel& m, const mjData& d, int dof) {
  double torque = 0;
  for (int a = 0; a < m.nactuator; ++a) {
    for (int o = 0; o < m.actuator_outnum[a]; ++o) {
      const int row = m.actuator_outadr[a] + o, adr = d.moment_rowadr[row];
      for (int k = adr; k < adr + d.moment_rownnz[row]; ++k) {
        if (d.moment_colind[k] == dof) torque += d.actuator_moment[k] * LimitedForce(m, d, a, o);
      }
    }
  }
  const int j = m.dof_jntid[dof];
  if (m.jnt_actfrclimited[j]) {
    torque = std::clamp(torque, m.jnt_actfrcrange[2 * j], m.jnt_actfrcrange[2 * j + 1]);
  }
  return torque;
}

// Gravity on everything beyond the joint, about its axis.
double GravityTorque(const mjModel& m, const mjData& d, int dof) {
  if (m.opt.disableflags & mjDSBL_GRAVITY) return 0;
  const int b = m.dof_bodyid[dof], root = m.body_rootid[b];
  const double* cdof = d.cdof + 6 * dof;  // rotation, translation at the root's subtree_com
  double arm[3], velocity[3];
  mju_sub3(arm, d.subtree_com + 3 * b, d.subtree_com + 3 * root);
  mju_cross(velocity, cdof, arm);
  mju_addTo3(velocity, cdof + 3);
  return m.body_subtreemass[b] * mju_dot3(velocity, m.opt.gravity);
}

// Forces on bodies (xfrc_applied), about the joint's axis.
double AppliedTorque(const mjModel& m, const mjData& d, int dof) {
  double torque = d.qfrc_applied[dof];
  const double* cdof = d.cdof + 6 * dof;
  const int first = m.dof_bodyid[dof];
  for (int b = first; b < m.nbody; ++b) {
    const double* wrench = d.xfrc_applied + 6 * b;
    if (std::all_of(wrench, wrench + 6, [](double x) { return x == 0; })) continue;
    int a = b;
    while (a > first) a = m.body_parentid[a];
    if (a != first) continue;
    double arm[3], velocity[3];
    mju_sub3(arm, d.xipos + 3 * b, d.subtree_com + 3 * m.body_rootid[b]);
    mju_cross(velocity, cdof, arm);
    mju_addTo3(velocity, cdof + 3);
    torque += mju_dot3(velocity, wrench) + mju_dot3(cdof, wrench + 3);
  }
  return torque;
}

}  // namespace

double GearTorque(const mjModel& m, const mjData& d, int dof, int option) {
  const double actuator = ActuatorTorque(m, d, dof);
  if (option == 1) return actuator;
  const double external = d.qfrc_passive[dof] - d.qfrc_damper[dof] + GravityTorque(m, d, dof) +
                          AppliedTorque(m, d, dof);
  return actuator - external;
}

double GearLoad(const mjModel& m, const mjData& d, int dof, int option) {
  return LoadOf(GearTorque(m, d, dof, option), option);
}

}  // namespace continuum
