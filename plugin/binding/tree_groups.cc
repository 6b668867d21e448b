#include "binding/tree_groups.h"

#include <map>
#include <numeric>

namespace continuum {

std::vector<int> TreeGroups(const mjModel& m, const std::vector<std::vector<int>>& dofs) {
  std::vector<int> joined(m.ntree);
  std::iota(joined.begin(), joined.end(), 0);
  const auto root = [&](int tree) {
    while (joined[tree] != tree) tree = joined[tree] = joined[joined[tree]];
    return tree;
  };
  for (const auto& each : dofs) {
    for (const int dof : each) joined[root(m.dof_treeid[dof])] = root(m.dof_treeid[each.front()]);
  }
  std::map<int, int> number;
  std::vector<int> groups;
  for (const auto& each : dofs) {
    const int key = each.empty() ? -1 : root(m.dof_treeid[each.front()]);
    groups.push_back(number.try_emplace(key, static_cast<int>(number.size())).first->second);
  }
  return groups;
}

}  // namespace continuum
