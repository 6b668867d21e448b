#include "binding/step_inertia.h"

#include <algorithm>

namespace continuum {

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

void StepInertia::Update(const mjModel& m, const mjData& d, const StepDamping& damping) {
  Mass(m, d, matrix_);
  for (std::size_t i = 0; i < dofs_.size(); ++i)
    matrix_[i * (size() + 1)] += damping.joint[dofs_[i]];
  for (const StepDamping::Term& term : damping.terms) Add(term);
}

void StepInertia::Mass(const mjModel& m, const mjData& d, std::vector<double>& mass) const {
  const int n = size(), joints = n - ends_;
  mass.assign(n * n, 0);
  for (int i = joints; i < n; ++i) mass[i * (n + 1)] = kEndDrag * m.opt.timestep;
  for (int i = 0; i < joints; ++i) {
    const int begin = m.M_rowadr[dofs_[i]], end = begin + m.M_rownnz[dofs_[i]];
    for (int k = begin; k < end; ++k) {
      const int j = index_[m.M_colind[k]];
      mass[j * n + i] = mass[i * n + j] = d.M[k];  // MuJoCo's is the lower triangle
    }
  }
}

void StepInertia::Add(const StepDamping::Term& term) {
  for (std::size_t i = 0; i < term.dof.size(); ++i) {
    for (std::size_t j = 0; j < term.dof.size(); ++j) {
      const int row = index_[term.dof[i]], column = index_[term.dof[j]];
      if (row >= 0 && column >= 0)
        matrix_[row * size() + column] += term.scale * term.J[i] * term.J[j];
    }
  }
}

}  // namespace continuum
