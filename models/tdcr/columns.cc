#include "models/tdcr/columns.h"

#include <string>
#include <vector>

#include "models/statics/columns.h"
#include "sim/io/excerpt.h"

namespace continuum::tdcr {
namespace {

constexpr std::size_t kShown = 200;  // characters of a list of names

std::vector<std::string> KnownColumns(const std::string& drive, int tendons, int disks) {
  std::vector<std::string> known{"case", "fx", "fy", "fz", "gx", "gy",
                                 "gz",   "mu", "mx", "my", "mz", "reference"};
  for (const std::string& prefix : {drive, std::string("dir")}) {
    for (int k = 1; k <= tendons; ++k) known.push_back(prefix + std::to_string(k));
  }
  for (int i = 1; i <= disks; ++i) {
    for (const char* load : {"fx_", "fy_", "fz_", "mx_", "my_", "mz_"}) {
      known.push_back(load + std::to_string(i));
    }
  }
  return known;
}

std::string Together(const std::vector<std::string>& names) {
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace

void RequireKnownKeys(const Yaml& robot) {
  if (robot.Has("sections")) {
    return robot.Only({"format", "robot", "sections", "tendons", "mu", "tendon_EA", "gravity",
                       "base_rotation", "calibration"});
  }
  robot.Only({"format", "robot", "length", "diameter", "disks", "tendons", "tendon_radius", "E",
              "nu", "density", "disk_mass", "mu", "tendon_EA", "gravity", "base_rotation",
              "precurvature", "tendon_angles", "calibration", "hybrid"});
}

void RequireKnownCaseColumns(const CsvTable& cases, int tendons, int disks) {
  const auto known = KnownColumns(statics::DriveOf(cases, {"L", "T"}), tendons, disks);
  statics::RefuseOtherColumns(cases, known, "columns among " + Excerpt(Together(known), kShown));
}

}  // namespace continuum::tdcr
