#include "binding/applied_force.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "binding/actuator_force.h"

namespace continuum {
namespace {

void AddActuators(const mjModel& m, const mjData& d, double* force) {
  for (int a = 0; a < m.nactuator; ++a) {
    for (int o = 0; o < m.actuator_outnum[a]; ++o) {
      const double f = LimitedForce(m, d, a, o);
      const int row = m.actuator_outadr[a] + o, adr = d.moment_rowadr[row];
      for (int k = adr; k < adr + d.moment_rownnz[row]; ++k) {
        force[d.moment_colind[k]] += d.actuator_moment[k] * f;
      }
    }
  }
}

void AddCompensation(const mjModel& m, const mjData& d, double* force) {
  for (int dof = 0; dof < m.nv; ++dof) {
    if (m.jnt_actgravcomp[m.dof_jntid[dof]]) force[dof] += d.qfrc_gravcomp[dof];
  }
}

void LimitJoints(const mjModel& m, double* force) {
  for (int j = 0; j < m.njnt; ++j) {
    if (!m.jnt_actfrclimited[j]) continue;
    const double* const range = m.jnt_actfrcrange + 2 * j;
    double& f = force[m.jnt_dofadr[j]];
    f = std::clamp(f, range[0], range[1]);
  }
}

void AddWrenches(const mjModel& m, const mjData& d, double* force) {
  std::uint64_t some = 0;  // without branches: the compiler then works on several numbers at once
  for (int i = 6; i < 6 * m.nbody; ++i) some |= std::bit_cast<std::uint64_t>(d.xfrc_applied[i]);
  if (some == 0) return;
  for (int b = 1; b < m.nbody; ++b) {
    const double* const w = d.xfrc_applied + 6 * b;
    if (std::all_of(w, w + 6, [](double x) { return x == 0; })) continue;
    const double* const centre = d.subtree_com + 3 * m.body_rootid[b];
    double arm[3], moment[3];
    mju_sub3(arm, d.xipos + 3 * b, centre);
    mju_cross(moment, arm, w);
    mju_addTo3(moment, w + 3);
    for (int a = b; a > 0; a = m.body_parentid[a]) {
      for (int dof = m.body_dofadr[a]; dof < m.body_dofadr[a] + m.body_dofnum[a]; ++dof) {
        force[dof] += mju_dot3(d.cdof + 6 * dof, moment) + mju_dot3(d.cdof + 6 * dof + 3, w);
      }
    }
  }
}

}  // namespace

void ActuatorForces(const mjModel& m, const mjData& d, double* force) {
  std::fill_n(force, m.nv, 0.0);
  if (IsUnactuated(m)) return;
  AddActuators(m, d, force);
  AddCompensation(m, d, force);
}

void AppliedForces(const mjModel& m, const mjData& d, double* force) {
  ActuatorForces(m, d, force);
  if (!IsUnactuated(m)) LimitJoints(m, force);
  AddWrenches(m, d, force);
  for (int dof = 0; dof < m.nv; ++dof) {
    force[dof] += d.qfrc_passive[dof] - d.qfrc_bias[dof] + d.qfrc_applied[dof];
  }
}

}  // namespace continuum
