#include "binding/cable_islands.h"

#include <algorithm>

#include "binding/tree_groups.h"

namespace continuum {

CableIslands::CableIslands(const mjModel& m, const CableGeometry& geometry)
    : of_cable_(geometry.cables()), end_(geometry.cables()) {
  for (int c = 0; c < geometry.cables(); ++c) {
    const int* const all = geometry.dof.data();
    moved_.emplace_back(all + geometry.begin[geometry.first[c]],
                        all + geometry.begin[geometry.first[c + 1]]);
  }
  Link(m, geometry, {});
}

void CableIslands::Link(const mjModel& m, const CableGeometry& geometry,
                        std::span<const SolvedRow> rows) {
  if (rows.empty() && moved_.size() == of_cable_.size() && !island_of_tree_.empty()) return;
  moved_.resize(of_cable_.size());
  for (const SolvedRow& row : rows) moved_.push_back(row.dof);
  const std::vector<int> group = TreeGroups(m, moved_);
  std::copy_n(group.begin(), of_cable_.size(), of_cable_.begin());
  const int islands = 1 + *std::max_element(of_cable_.begin(), of_cable_.end());
  rows_.assign(islands, {});
  std::vector<int> island_of_tree(m.ntree, -1);
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (group[k] >= islands) continue;  // groups count from the cables on
    for (const int dof : moved_[k]) island_of_tree[m.dof_treeid[dof]] = group[k];
    if (k >= of_cable_.size()) rows_[group[k]].push_back(static_cast<int>(k - of_cable_.size()));
  }
  if (island_of_tree == island_of_tree_ && !inertias_.empty()) return;
  island_of_tree_.swap(island_of_tree);
  Build(m, geometry);
}

void CableIslands::Build(const mjModel& m, const CableGeometry& geometry) {
  std::vector<std::vector<int>> dofs(rows_.size());
  for (int dof = 0; dof < m.nv; ++dof) {
    const int island = island_of_tree_[m.dof_treeid[dof]];
    if (island >= 0) dofs[island].push_back(dof);
  }
  std::vector<int> ends(rows_.size());
  for (int c = 0; c < geometry.cables(); ++c)
    end_[c] = geometry.both[c] ? ends[of_cable_[c]]++ : -1;
  inertias_.clear(), articulated_.clear(), place_.clear();
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    inertias_.emplace_back(m, dofs[k], ends[k]);
    articulated_.emplace_back(m, inertias_.back().dofs());
  }
  for (int c = 0; c < geometry.cables(); ++c) AddPlaces(geometry, c);
}

void CableIslands::AddPlaces(const CableGeometry& geometry, int c) {
  const StepInertia& inertia = inertias_[of_cable_[c]];
  for (int l = geometry.begin[geometry.first[c]]; l < geometry.begin[geometry.first[c + 1]]; ++l)
    place_.push_back(inertia.index(geometry.dof[l]));
  if (end_[c] >= 0) end_[c] += static_cast<int>(inertia.dofs().size());
}

}  // namespace continuum
