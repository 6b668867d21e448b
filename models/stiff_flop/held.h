#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "models/statics/held_robot.h"

namespace continuum::stiff_flop {

/// Pressures to shapes: StateColumns(), `x, y, z`, `tx, ty, tz`, `kappa, phi, lambda_l`, those of
/// DetailColumns. With `inverse` shapes to pressures: `p1`.. in place of `kappa, phi, lambda_l`.
/// @throws Error for a bad file or method; empty: the usual one.
std::unique_ptr<statics::HeldRobot> Hold(const std::filesystem::path& robot,
                                         const std::string& method, bool inverse);

}  // namespace continuum::stiff_flop
