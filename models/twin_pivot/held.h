#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "models/statics/held_robot.h"

namespace continuum::twin_pivot {

/// Results: StateColumns(), `x, y, z`, those of DetailColumns, `beta_m` and `x_m, y_m, z_m` of the
/// discs. A row whose loads leave one equilibrium starts from the one before.
/// @throws Error for a bad file or method; empty: the usual one.
std::unique_ptr<statics::HeldRobot> Hold(const std::filesystem::path& robot,
                                         const std::string& method);

}  // namespace continuum::twin_pivot
