#pragma once

#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Groups of things that move degrees of freedom: two are in one group where they, or a chain of
/// others, have a kinematic tree in common. dofs: of each thing; returns the number of the group of
/// each, counted from 0 as they appear.
std::vector<int> TreeGroups(const mjModel& m, const std::vector<std::vector<int>>& dofs);

}  // namespace continuum
