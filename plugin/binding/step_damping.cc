#include "binding/step_damping.h"

namespace continuum {
namespace {

bool TakesJointDamping(const mjModel& m) {
  if (m.opt.disableflags & mjDSBL_DAMPER || m.opt.integrator == mjINT_RK4) return false;
  return m.opt.integrator != mjINT_EULER || !(m.opt.disableflags & mjDSBL_EULERDAMP);
}

bool TakesAllDamping(const mjModel& m) {
  return m.opt.integrator != mjINT_EULER && m.opt.integrator != mjINT_RK4;
}

// −d force/d velocity of an affine actuator that is not at its limit.
double Damping(const mjModel& m, const mjData& d, int a) {
  double damping = 0;
  if (m.actuator_biastype[a] == mjBIAS_AFFINE) damping -= m.actuator_biasprm[mjNBIAS * a + 2];
  if (m.actuator_gaintype[a] == mjGAIN_AFFINE && m.actuator_dyntype[a] == mjDYN_NONE) {
    damping -= m.actuator_gainprm[mjNGAIN * a + 2] * d.ctrl[a];
  }
  if (damping == 0) return 0;
  const double force = d.actuator_force[m.actuator_outadr[a]];
  const double* const range = m.actuator_forcerange + 2 * a;
  const bool limited = m.actuator_forcelimited[a] && (force <= range[0] || force >= range[1]);
  return limited ? 0 : damping;
}

}  // namespace

void StepDamping::Update(const mjModel& m, const mjData& d) {
  const double h = m.opt.timestep;
  joint.assign(m.nv, 0), terms.clear();
  if (TakesJointDamping(m)) {
    for (int dof = 0; dof < m.nv; ++dof) joint[dof] = h * m.dof_damping[dof];
  }
  if (!TakesAllDamping(m)) return;
  for (int t = 0; t < m.ntendon; ++t) {
    const double damping = m.opt.disableflags & mjDSBL_DAMPER ? 0 : m.tendon_damping[t];
    if (damping <= 0) continue;
    const int adr = m.ten_J_rowadr[t];
    Add(h * damping, {m.ten_J_colind + adr, static_cast<std::size_t>(m.ten_J_rownnz[t])},
        d.ten_J + adr);
  }
  for (int a = 0; a < m.nactuator; ++a) {
    const double damping = Damping(m, d, a);
    if (damping <= 0) continue;
    const int row = m.actuator_outadr[a], adr = d.moment_rowadr[row];
    Add(h * damping, {d.moment_colind + adr, static_cast<std::size_t>(d.moment_rownnz[row])},
        d.actuator_moment + adr);
  }
}

void StepDamping::Add(double scale, std::span<const int> dof, const double* J) {
  if (dof.size() == 1) {
    joint[dof[0]] += scale * J[0] * J[0];
  } else if (!dof.empty()) {
    terms.push_back({scale, dof, J});
  }
}

}  // namespace continuum
