#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Effects that models bring along which another one attaches (<asset><model file="…"/>), and which
/// are not in what it compiles to: MuJoCo keeps the instances that an element refers to. A sentence
/// for each.
std::vector<std::string> LostInstances(const std::filesystem::path& model, const mjModel& compiled);

}  // namespace continuum
