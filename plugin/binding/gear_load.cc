#include "binding/gear_load.h"

#include <algorithm>

#include "binding/applied_force.h"

namespace continuum {

double WeightTorque(const mjModel& m, const mjData& d, int dof) {
  if (m.opt.disableflags & mjDSBL_GRAVITY) return 0;
  const int b = m.dof_bodyid[dof], root = m.body_rootid[b];
  const double* cdof = d.cdof + 6 * dof;  // rotation, translation at the root's subtree_com
  double arm[3], velocity[3];
  mju_sub3(arm, d.subtree_com + 3 * b, d.subtree_com + 3 * root);
  mju_cross(velocity, cdof, arm);
  mju_addTo3(velocity, cdof + 3);
  return m.body_subtreemass[b] * mju_dot3(velocity, m.opt.gravity);
}

namespace {

bool IsPushed(const mjData& d, int body) {
  const double* const wrench = d.xfrc_applied + 6 * body;
  return std::any_of(wrench, wrench + 6, [](double x) { return x != 0; });
}

}  // namespace

GearTorques::GearTorques(const mjModel& m, const mjData& d) : actuators_(m.nv) {
  ActuatorForces(m, d, actuators_.data());
  for (int b = 1; b < m.nbody; ++b) {
    if (IsPushed(d, b)) pushed_.push_back(b);
  }
}

// Forces on bodies (xfrc_applied), about the joint's axis.
double GearTorques::Applied(const mjModel& m, const mjData& d, int dof) const {
  double torque = d.qfrc_applied[dof];
  const double* const cdof = d.cdof + 6 * dof;
  const int first = m.dof_bodyid[dof];
  for (const int b : pushed_) {
    int a = b;
    while (a > first) a = m.body_parentid[a];
    if (a != first) continue;
    const double* const wrench = d.xfrc_applied + 6 * b;
    double arm[3], velocity[3];
    mju_sub3(arm, d.xipos + 3 * b, d.subtree_com + 3 * m.body_rootid[b]);
    mju_cross(velocity, cdof, arm);
    mju_addTo3(velocity, cdof + 3);
    torque += mju_dot3(velocity, wrench) + mju_dot3(cdof, wrench + 3);
  }
  return torque;
}

double GearTorques::At(const mjModel& m, const mjData& d, int dof, int option) const {
  double actuator = actuators_[dof];
  const int j = m.dof_jntid[dof];
  if (m.jnt_actfrclimited[j]) {  // the range of the joint, after those of the actuators
    actuator = std::clamp(actuator, m.jnt_actfrcrange[2 * j], m.jnt_actfrcrange[2 * j + 1]);
  }
  if (option == 1) return actuator;
  const double external =
      d.qfrc_passive[dof] - d.qfrc_damper[dof] + WeightTorque(m, d, dof) + Applied(m, d, dof);
  return actuator - external;
}

}  // namespace continuum
