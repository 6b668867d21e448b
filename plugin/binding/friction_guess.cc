#include "binding/friction_guess.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "binding/applied_force.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

constexpr int kPatience = 5, kRounds = 40;

bool HasFriction(const mjModel& m, int tree) {
  const double* const loss = m.dof_frictionloss + m.tree_dofadr[tree];
  return std::any_of(loss, loss + m.tree_dofnum[tree], [](double x) { return x > 0; });
}

// Whether a tree has rows of other kinds, or is tied to one that has.
bool HasOthers(const mjData& d, int tree) {
  if (d.nisland == 0) return d.ne > 0 || d.nf < d.nefc;
  const int island = d.tree_island[tree];
  return island >= 0 && (d.island_ne[island] > 0 || d.island_nf[island] < d.island_nefc[island]);
}

// Rows of ours have an anchor, which MuJoCo's own have not.
bool HasAnchor(const mjData& d, int r) { return r >= 0 && d.efc_KBIP[4 * r] > 0; }

double Reference(const mjData& d, int r, int dof) {
  const double* const kbip = d.efc_KBIP + 4 * r;
  return -kbip[1] * d.qvel[dof] - kbip[0] * kbip[2] * d.efc_pos[r];
}

}  // namespace

FrictionGuess::FrictionGuess(const mjModel& m)
    : row_(m.nv), side_(m.nv), better_(m.nv), force_(m.nv), held_(m.nv) {
  for (int t = 0; t < m.ntree; ++t) {
    if (!HasFriction(m, t)) continue;
    std::vector<int> dofs(m.tree_dofnum[t]);
    for (int k = 0; k < m.tree_dofnum[t]; ++k) dofs[k] = m.tree_dofadr[t] + k;
    trees_.push_back({t, dofs, ArticulatedInertia(m, dofs)});
  }
}

void FrictionGuess::Write(const mjModel& m, mjData& d) {
  if (trees_.empty() || d.nf == 0 || IsDiscrete(m) || !ArticulatedInertia::Covers(m)) return;
  std::fill(row_.begin(), row_.end(), -1);
  for (int r = d.ne; r < d.ne + d.nf; ++r) {
    if (d.efc_type[r] != mjCNSTR_FRICTION_DOF) return;
    row_[d.efc_id[r]] = r;
  }
  bool applied = false;
  for (Tree& tree : trees_) {
    const auto ours = [&](int dof) { return HasAnchor(d, row_[dof]); };
    if (std::none_of(tree.dofs.begin(), tree.dofs.end(), ours) || HasOthers(d, tree.id)) continue;
    if (!std::exchange(applied, true)) AppliedForces(m, d, force_.data());
    if (!Solve(m, d, tree)) continue;
    std::copy(answer_.begin(), answer_.end(), d.qacc_warmstart + tree.dofs.front());
  }
}

bool FrictionGuess::Solve(const mjModel& m, const mjData& d, Tree& tree) {
  const int first = tree.dofs.front();
  answer_.assign(tree.dofs.size(), 0);
  for (const int dof : tree.dofs) side_[dof] = 0;
  Judge(d, tree, d.qacc_warmstart + first), Change(tree, false);
  int fewest = static_cast<int>(tree.dofs.size()) + 1, patience = kPatience;
  for (int round = 0; round < kRounds; ++round) {
    for (const int dof : tree.dofs) {
      const int r = row_[dof], side = side_[dof];
      held_[dof] = 0;
      double& b = answer_[dof - first] = force_[dof];
      if (r < 0) continue;
      if (side == 0) held_[dof] = d.efc_D[r];
      b += side == 0 ? d.efc_D[r] * Reference(d, r, dof) : side * d.efc_frictionloss[r];
    }
    tree.inertia.Update(m, d, held_);
    tree.inertia.Solve(answer_.data());
    const int wrong = Judge(d, tree, answer_.data());
    if (wrong == 0) return true;
    patience = wrong < fewest ? kPatience : patience - 1;
    fewest = std::min(fewest, wrong);
    Change(tree, patience < 0);
  }
  return false;
}

void FrictionGuess::Change(const Tree& tree, bool one) {
  for (std::size_t k = tree.dofs.size(); k-- > 0;) {
    const int dof = tree.dofs[k];
    if (row_[dof] < 0 || side_[dof] == better_[dof]) continue;
    side_[dof] = better_[dof];
    if (one) return;
  }
}

// (2); returns how many rows have to change. One at its level may be on either side of it by
// roundings. One that slides the wrong way holds first.
int FrictionGuess::Judge(const mjData& d, const Tree& tree, const double* acceleration) {
  constexpr double kError = 1e-12;
  int wrong = 0;
  for (const int dof : tree.dofs) {
    const int r = row_[dof];
    if (r < 0) continue;
    const double force =
        d.efc_D[r] * (Reference(d, r, dof) - acceleration[dof - tree.dofs.front()]);
    const double level = d.efc_frictionloss[r];
    if (side_[dof] == 0) {
      better_[dof] = std::abs(force) <= level * (1 + kError) ? 0 : force > 0 ? 1 : -1;
    } else {
      better_[dof] = side_[dof] * force >= level * (1 - kError) ? side_[dof] : 0;
    }
    wrong += better_[dof] != side_[dof];
  }
  return wrong;
}

}  // namespace continuum
