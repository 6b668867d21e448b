#include "binding/step_inertia.h"

#include <algorithm>

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
  const double force = d.actuator_force[m.actuator_outadr[a]];
  const double* const range = m.actuator_forcerange + 2 * a;
  const bool limited = m.actuator_forcelimited[a] && (force <= range[0] || force >= range[1]);
  return limited ? 0 : damping;
}

}  // namespace

StepInertia::StepInertia(const mjModel& m, std::span<const int> dofs, int ends)
    : index_(m.nv, -1), ends_(ends) {
  std::vector<bool> used(m.ntree);
  for (const int dof : dofs) used[m.dof_treeid[dof]] = true;
  for (int dof = 0; dof < m.nv; ++dof) {
    if (!used[m.dof_treeid[dof]]) continue;
    index_[dof] = static_cast<int>(dofs_.size());
    dofs_.push_back(dof);
  }
}

void StepInertia::Update(const mjModel& m, const mjData& d) {
  Mass(m, d, matrix_);
  AddDamping(m, d);
}

void StepInertia::Mass(const mjModel& m, const mjData& d, std::vector<double>& mass) const {
  const int n = size(), joints = n - ends_;
  if (static_cast<int>(mass.size()) != n * n) mass.assign(n * n, 0);
  for (int i = 0; i < n; ++i) std::fill_n(mass.data() + i * (n + 1), n - i, 0.0);
  for (int i = joints; i < n; ++i) mass[i * (n + 1)] = kEndDrag * m.opt.timestep;
  for (int i = 0; i < joints; ++i) {
    const int begin = m.M_rowadr[dofs_[i]], end = begin + m.M_rownnz[dofs_[i]];
    for (int k = begin; k < end; ++k) {
      const int j = index_[m.M_colind[k]];
      mass[j * n + i] = d.M[k];  // j ≤ i: MuJoCo's is the lower one
    }
  }
}

void StepInertia::AddDamping(const mjModel& m, const mjData& d) {
  const double h = m.opt.timestep;
  if (TakesJointDamping(m)) {
    for (std::size_t i = 0; i < dofs_.size(); ++i)
      matrix_[i * (size() + 1)] += h * m.dof_damping[dofs_[i]];
  }
  if (!TakesAllDamping(m)) return;
  for (int t = 0; t < m.ntendon; ++t) {
    const double damping = m.opt.disableflags & mjDSBL_DAMPER ? 0 : m.tendon_damping[t];
    const int adr = m.ten_J_rowadr[t];
    const auto n = static_cast<std::size_t>(m.ten_J_rownnz[t]);
    if (damping > 0) AddOuter(h * damping, {m.ten_J_colind + adr, n}, d.ten_J + adr);
  }
  for (int a = 0; a < m.nactuator; ++a) {
    const double damping = Damping(m, d, a);
    const int row = m.actuator_outadr[a], adr = d.moment_rowadr[row];
    const auto n = static_cast<std::size_t>(d.moment_rownnz[row]);
    if (damping > 0) AddOuter(h * damping, {d.moment_colind + adr, n}, d.actuator_moment + adr);
  }
}

void StepInertia::AddOuter(double scale, std::span<const int> dofs, const double* x) {
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const int row = index_[dofs[i]], column = index_[dofs[j]];
      if (row >= 0 && column >= row) matrix_[row * size() + column] += scale * x[i] * x[j];
    }
  }
}

}  // namespace continuum
