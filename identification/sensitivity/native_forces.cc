#include "identification/sensitivity/native_forces.h"

#include <algorithm>
#include <cmath>

#include "binding/force.h"
#include "mujoco_compat.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

double Lag(const mjModel& m, int a) { return std::max(mjMINVAL, m.actuator_dynprm[a * mjNDYN]); }

bool All0(const double* x, int n) {
  return std::all_of(x, x + n, [](double v) { return v == 0; });
}

std::string JointObstacle(const mjModel& m, int j) {
  if (m.jnt_type[j] != mjJNT_HINGE && m.jnt_type[j] != mjJNT_SLIDE) return "is no hinge or slide";
  if (!All0(m.jnt_stiffnesspoly + mjNPOLY * j, mjNPOLY) ||
      !All0(m.dof_dampingpoly + mjNPOLY * m.jnt_dofadr[j], mjNPOLY))
    return "has a curved spring or damper";
  if (m.jnt_springyield[j] > 0) return "has a spring that yields";
  if (m.jnt_actfrclimited[j]) return "limits what actuators give";
  return "";
}

std::string TendonObstacle(const mjModel& m, int t) {
  if (!All0(m.tendon_stiffnesspoly + mjNPOLY * t, mjNPOLY) ||
      !All0(m.tendon_dampingpoly + mjNPOLY * t, mjNPOLY))
    return "has a curved spring or damper";
  if (m.tendon_springyield[t] > 0) return "has a spring that yields";
  if (m.tendon_actfrclimited[t]) return "limits what actuators give";
  return "";
}

std::string ActuatorObstacle(const mjModel& m, int a) {
  const int kind = m.actuator_trntype[a];
  if (kind != mjTRN_JOINT && kind != mjTRN_JOINTINPARENT && kind != mjTRN_TENDON)
    return "pulls neither a joint nor a tendon";
  const int gain = m.actuator_gaintype[a], bias = m.actuator_biastype[a];
  if ((gain != mjGAIN_FIXED && gain != mjGAIN_AFFINE) ||
      (bias != mjBIAS_NONE && bias != mjBIAS_AFFINE))
    return "has a gain or bias that is not affine";
  const int dyn = m.actuator_dyntype[a];
  if (dyn != mjDYN_NONE && dyn != mjDYN_INTEGRATOR && dyn != mjDYN_FILTER &&
      dyn != mjDYN_FILTEREXACT)
    return "has dynamics of its own";
  if (m.actuator_actadr[a] >= 0 && m.actuator_actlimited[a]) return "limits its activation";
  if (m.actuator_damping[a] != 0 || m.actuator_armature[a] != 0 ||
      !All0(m.actuator_dampingpoly + mjNPOLY * a, mjNPOLY))
    return "has a damping or an armature";
  return "";
}

}  // namespace

ForceAlong& ForceAlong::operator+=(const ForceAlong& more) {
  f += more.f, by_length += more.by_length, by_rate += more.by_rate;
  return *this;
}

ForceAlong ForceAlong::Felt(double faster) const {
  ForceAlong felt = *this;
  felt.f += by_rate * faster;
  return felt;
}

ForceAlong ForceAlong::Times(double factor) const {
  return {factor * f, factor * by_length, factor * by_rate, factor * by_activation};
}

std::string NativeForceObstacle(const mjModel& m) {
  for (int j = 0; j < m.njnt; ++j) {
    if (const std::string why = JointObstacle(m, j); !why.empty())
      return "joint " + Called(m, mjOBJ_JOINT, j) + " " + why;
  }
  for (int t = 0; t < m.ntendon; ++t) {
    if (const std::string why = TendonObstacle(m, t); !why.empty())
      return "tendon " + Called(m, mjOBJ_TENDON, t) + " " + why;
  }
  for (int a = 0; a < m.nactuator; ++a) {
    if (const std::string why = ActuatorObstacle(m, a); !why.empty())
      return "actuator " + Called(m, mjOBJ_ACTUATOR, a) + " " + why;
  }
  if (m.nu != m.nactuator) return "an actuator has several inputs";
  if (m.opt.disableactuator != 0) return "a group of actuators is disabled";
  if (m.opt.density != 0 || m.opt.viscosity != 0) return "a fluid acts";
  if (!All0(m.body_gravcomp, static_cast<int>(m.nbody))) return "gravity is compensated";
  if (m.nflex > 0) return "a flex bends";
  return "";
}

ForceAlong JointForce(const mjModel& m, const mjData& d, int joint, double v) {
  ForceAlong pull;
  const int dof = m.jnt_dofadr[joint], adr = m.jnt_qposadr[joint];
  if (!(m.opt.disableflags & mjDSBL_SPRING)) {
    pull.by_length = -m.jnt_stiffness[joint];
    pull.f += pull.by_length * (d.qpos[adr] - m.qpos_spring[adr]);
  }
  if (!(m.opt.disableflags & mjDSBL_DAMPER)) {
    pull.by_rate = -m.dof_damping[dof];
    pull.f += pull.by_rate * v;
  }
  return pull;
}

ForceAlong TendonForce(const mjModel& m, const mjData& d, int tendon, double rate) {
  ForceAlong pull;
  if (!(m.opt.disableflags & mjDSBL_SPRING) && m.tendon_stiffness[tendon] != 0) {
    const double* const rest = m.tendon_lengthspring + 2 * tendon;
    const double beyond = BeyondRest(m, tendon, d.ten_length[tendon]);
    if (beyond != 0 || rest[0] == rest[1]) pull.by_length = -m.tendon_stiffness[tendon];
    pull.f += pull.by_length * beyond;
  }
  if (!(m.opt.disableflags & mjDSBL_DAMPER)) {
    pull.by_rate = -m.tendon_damping[tendon];
    pull.f += pull.by_rate * rate;
  }
  return pull;
}

std::vector<double> ControlsMet(const mjModel& m, const mjData& d) {
  std::vector<double> met(d.ctrl, d.ctrl + m.nu);
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_delay[a] > 0) met[m.actuator_ctrladr[a]] = ReadControl(m, d, a);
  }
  return met;
}

double ControlWithin(const mjModel& m, const mjData& d, int a) {
  const bool clamped = m.actuator_ctrllimited[a] && !(m.opt.disableflags & mjDSBL_CLAMPCTRL);
  const double* const range = m.actuator_ctrlrange + 2 * a;
  return clamped ? std::clamp(d.ctrl[a], range[0], range[1]) : d.ctrl[a];
}

double ActuatedLength(const mjModel& m, const mjData& d, int a) {
  const int id = m.actuator_trnid[2 * a];
  return m.actuator_trntype[a] == mjTRN_TENDON ? d.ten_length[id] : d.qpos[m.jnt_qposadr[id]];
}

Activation RateOfActivation(const mjModel& m, const mjData& d, int a) {
  const double u = ControlWithin(m, d, a);
  if (m.actuator_dyntype[a] == mjDYN_INTEGRATOR) return {u, 0, 1};
  return {(u - d.act[m.actuator_actadr[a]]) / Lag(m, a), -1 / Lag(m, a), 1 / Lag(m, a)};
}

double ActivationSpan(const mjModel& m, int a, double step) {
  if (m.actuator_dyntype[a] != mjDYN_FILTEREXACT) return step;
  return Lag(m, a) * -std::expm1(-step / Lag(m, a));
}

Activation NextActivation(const mjModel& m, const mjData& d, int a, double step) {
  const double act = d.act[m.actuator_actadr[a]], span = ActivationSpan(m, a, step);
  const Activation rate = RateOfActivation(m, d, a);
  return {act + span * rate.value, 1 + span * rate.by_itself, span * rate.by_input};
}

ActuatorOutput UnlimitedOutput(const mjModel& m, const mjData& d, int a, double rate, double step) {
  const double gear = m.actuator_gear[6 * m.actuator_outadr[a]];
  const double length = gear * ActuatedLength(m, d, a);
  const double* const g = m.actuator_gainprm + mjNGAIN * a;
  const double* const b = m.actuator_biasprm + mjNBIAS * a;
  const bool affine = m.actuator_gaintype[a] == mjGAIN_AFFINE;
  const bool biased = m.actuator_biastype[a] == mjBIAS_AFFINE;
  const int act = m.actuator_actadr[a];
  Activation input{ControlWithin(m, d, a), 0, 1};
  if (act >= 0) {
    input = m.actuator_actearly[a] ? NextActivation(m, d, a, step) : Activation{d.act[act], 1, 0};
  }
  const double gain = g[0] + (affine ? g[1] * length + g[2] * gear * rate : 0);
  ActuatorOutput out;
  out.f = gain * input.value;
  if (biased) out.f += b[0] + b[1] * length + b[2] * gear * rate;
  out.by_length = gear * ((affine ? g[1] * input.value : 0) + (biased ? b[1] : 0));
  out.by_rate = gear * ((affine ? g[2] * input.value : 0) + (biased ? b[2] : 0));
  out.by_activation = gain * input.by_itself, out.by_input = gain * input.by_input;
  return out;
}

ForceAlong ActuatorForce(const mjModel& m, const mjData& d, int a, double rate, double step) {
  ForceAlong pull;
  if (m.opt.disableflags & mjDSBL_ACTUATION) return pull;
  const double gear = m.actuator_gear[6 * m.actuator_outadr[a]];
  const ActuatorOutput out = UnlimitedOutput(m, d, a, rate, step);
  const double* const range = m.actuator_forcerange + 2 * a;
  if (m.actuator_forcelimited[a] && (out.f < range[0] || out.f > range[1])) {
    pull.f = gear * std::clamp(out.f, range[0], range[1]);
    return pull;
  }
  return {gear * out.f, gear * out.by_length, gear * out.by_rate, gear * out.by_activation};
}

}  // namespace continuum
