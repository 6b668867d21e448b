#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace continuum {

/// How many actuators `spa` has, and where they stand; other robots take none of these.
struct MakeLayout {
  std::optional<int> series = {}, rows = {};  ///< actuators on end, arms side by side
  std::optional<int> links = {};              ///< of each actuator
  bool standing = false;
};

/// The MJCF of a robot from its description (YAML). The key `robot` (stiff_flop: `model`) says how
/// it is built: annelida, spa, tdcr, twin_pivot or stiff_flop. An arm with the key `segments` is a
/// TendonArm, whatever its name.
///
/// variant: "" or another model of the same robot, as tdcr's disks, spa's free and series,
/// stiff_flop's braid. @throws Error with file:line for what the description lacks, for another
/// robot or variant, and for a layout of a robot that has none.
std::string MakeMjcf(const std::filesystem::path& robot, const std::string& variant,
                     const MakeLayout& layout = {});

}  // namespace continuum
