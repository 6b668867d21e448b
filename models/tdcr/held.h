#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "models/statics/held_robot.h"

namespace continuum::tdcr {

/// Results: StateColumns(), `x, y, z`, those of DetailColumns, `x_i, y_i, z_i` of the disks. A row
/// whose loads leave one equilibrium starts from the one before.
/// @throws Error for a bad file or method; empty: the usual one.
std::unique_ptr<statics::HeldRobot> Hold(const std::filesystem::path& robot,
                                         const std::string& method);

}  // namespace continuum::tdcr
