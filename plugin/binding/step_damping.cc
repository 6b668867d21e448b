#include "binding/step_damping.h"

#include <algorithm>

#include "binding/actuator_force.h"
#include "binding/applied_force.h"
#include "binding/damper.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

bool TakesJointDamping(const mjModel& m) {
  if (m.opt.disableflags & mjDSBL_DAMPER || m.opt.integrator == mjINT_RK4) return false;
  return m.opt.integrator != mjINT_EULER || !(m.opt.disableflags & mjDSBL_EULERDAMP);
}

bool TakesAllDamping(const mjModel& m) {
  return m.opt.integrator != mjINT_EULER && m.opt.integrator != mjINT_RK4;
}

bool IsScalar(const mjModel& m, int joint) {
  return m.jnt_type[joint] == mjJNT_HINGE || m.jnt_type[joint] == mjJNT_SLIDE;
}

// The joint of an actuator on a hinge or slide, else −1.
int JointOf(const mjModel& m, int a) {
  const int kind = m.actuator_trntype[a], joint = m.actuator_trnid[2 * a];
  const bool on_joint = kind == mjTRN_JOINT || kind == mjTRN_JOINTINPARENT;
  return on_joint && IsScalar(m, joint) ? joint : -1;
}

bool IsOff(const mjModel& m, int a) {
  constexpr int kLastGroup = 30;
  const int group = m.actuator_group[a];
  return group >= 0 && group <= kLastGroup && (m.opt.disableactuator >> group & 1);
}

// What the gain of an actuator multiplies: its control, else its activation.
double Input(const mjModel& m, const mjData& d, int a) {
  if (m.actuator_dyntype[a] != mjDYN_NONE) {
    const int last = m.actuator_actadr[a] + m.actuator_actnum[a] - 1;
    return d.act[last] + (m.actuator_actearly[a] ? m.opt.timestep * d.act_dot[last] : 0);
  }
  const double u = ReadControl(m, d, a);
  const int adr = m.actuator_ctrladr[a];
  if (!m.actuator_ctrllimited[adr] || m.opt.disableflags & mjDSBL_CLAMPCTRL) return u;
  return std::clamp(u, m.actuator_ctrlrange[2 * adr], m.actuator_ctrlrange[2 * adr + 1]);
}

// −d force/d velocity of an affine actuator.
double AffineDamping(const mjModel& m, const mjData& d, int a) {
  double damping = 0;
  if (m.actuator_biastype[a] == mjBIAS_AFFINE) damping -= m.actuator_biasprm[mjNBIAS * a + 2];
  if (m.actuator_gaintype[a] != mjGAIN_AFFINE) return damping;
  const double gain = m.actuator_gainprm[mjNGAIN * a + 2];
  return gain == 0 ? damping : damping - gain * Input(m, d, a);
}

// By its own range or that of its tendon.
bool IsAtRange(const mjModel& m, const mjData& d, int a) {
  double share = 1;
  if (m.actuator_trntype[a] == mjTRN_TENDON) share = TendonShare(m, d, m.actuator_trnid[2 * a]);
  if (share != 1) return true;
  const double force = d.actuator_force[m.actuator_outadr[a]];
  const double* const range = m.actuator_forcerange + 2 * a;
  return m.actuator_forcelimited[a] && (force <= range[0] || force >= range[1]);
}

}  // namespace

void StepDamping::Update(const mjModel& m, const mjData& d) {
  joint.assign(m.nv, 0), terms.clear(), torque_.clear();
  if (TakesJointDamping(m)) AddJoints(m, d);
  if (!TakesAllDamping(m)) return;
  if (!(m.opt.disableflags & mjDSBL_DAMPER)) AddTendons(m, d);
  if (!IsUnactuated(m)) AddActuators(m, d);
}

void StepDamping::AddJoints(const mjModel& m, const mjData& d) {
  const double h = m.opt.timestep;
  for (int dof = 0; dof < m.nv; ++dof) {
    const bool scalar = IsScalar(m, m.dof_jntid[dof]);
    joint[dof] = h * (scalar ? DofDamper(m, dof).Slope(d.qvel[dof]) : m.dof_damping[dof]);
  }
  for (int a = 0; a < m.nactuator; ++a) {
    const Damper damper = ActuatorDamper(m, a);
    const int j = damper.Any() ? JointOf(m, a) : -1;
    if (j >= 0) joint[m.jnt_dofadr[j]] += h * damper.Slope(d.qvel[m.jnt_dofadr[j]]);
  }
}

void StepDamping::AddTendons(const mjModel& m, const mjData& d) {
  tendon_.resize(m.ntendon);
  for (int t = 0; t < m.ntendon; ++t) tendon_[t] = TendonDamper(m, t).Slope(d.ten_velocity[t]);
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_trntype[a] != mjTRN_TENDON) continue;
    const int t = m.actuator_trnid[2 * a];
    tendon_[t] += ActuatorDamper(m, a).Slope(d.ten_velocity[t]);
  }
  for (int t = 0; t < m.ntendon; ++t) {
    if (tendon_[t] <= 0) continue;
    const int adr = m.ten_J_rowadr[t];
    Add(m.opt.timestep * tendon_[t],
        {m.ten_J_colind + adr, static_cast<std::size_t>(m.ten_J_rownnz[t])}, d.ten_J + adr);
  }
}

void StepDamping::AddActuators(const mjModel& m, const mjData& d) {
  for (int a = 0; a < m.nactuator; ++a) {
    if (IsOff(m, a)) continue;
    const double damping = AffineDamping(m, d, a);
    if (damping <= 0 || IsAtRange(m, d, a) || HasJointAtRange(m, d, a)) continue;
    const int row = m.actuator_outadr[a], adr = d.moment_rowadr[row];
    Add(m.opt.timestep * damping,
        {d.moment_colind + adr, static_cast<std::size_t>(d.moment_rownnz[row])},
        d.actuator_moment + adr);
  }
}

bool StepDamping::HasJointAtRange(const mjModel& m, const mjData& d, int a) {
  const int j = JointOf(m, a);
  if (j < 0 || !m.jnt_actfrclimited[j]) return false;
  if (torque_.empty()) torque_.resize(m.nv), ActuatorForces(m, d, torque_.data());
  const double torque = torque_[m.jnt_dofadr[j]], *const range = m.jnt_actfrcrange + 2 * j;
  return torque <= range[0] || torque >= range[1];
}

void StepDamping::Add(double scale, std::span<const int> dof, const double* J) {
  if (dof.size() == 1) {
    joint[dof[0]] += scale * J[0] * J[0];
  } else if (!dof.empty()) {
    terms.push_back({scale, dof, J});
  }
}

}  // namespace continuum
