#pragma once

#include <cstdint>
#include <filesystem>

#include "models/annelida/demo.h"

namespace continuum {

/// The paper's identification: eight repetitions of bending in the plane, four to the left and four
/// to the right, of which 1, 2, 5 and 8 are for fitting. Each pulls one cable to about 90 degrees
/// in 1 s, holds it for 0.5 s, and lets go for 2 s; joint rates are measured too. Made by the chain
/// written out with the robot's own parameters. draw: of the noise, from 1.
std::vector<DemoLog> RecordReleases(const AnnelidaParameters& p, std::uint64_t draw = 1);

/// Their experiment: stiffness, joint friction and cable friction, which start 30 to 60 % off.
std::string ReleasesExperiment(const std::filesystem::path& model);

}  // namespace continuum
