#pragma once

#include <filesystem>
#include <string>

namespace continuum {

/// The MJCF of a robot from its description (YAML). The key `robot` (stiff_flop: `model`) says how
/// it is built: annelida, spa, tdcr, twin_pivot or stiff_flop. An arm with the key `segments` is a
/// TendonArm, whatever its name.
///
/// variant: "" or another model of the same robot, as tdcr's disks, spa's free and series,
/// stiff_flop's braid. @throws Error with file:line for what the description lacks, and for another
/// robot or variant.
std::string MakeMjcf(const std::filesystem::path& robot, const std::string& variant);

}  // namespace continuum
