#include "models/tdcr/columns.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "error.h"
#include "sim/io/excerpt.h"

namespace continuum::tdcr {
namespace {

constexpr std::size_t kShown = 200;  // characters of a list of names

std::string Lowered(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    if (c != '_' && c != ' ') plain += static_cast<char>(std::tolower(c));
  }
  return plain;
}

std::vector<std::string> KnownColumns(int tendons) {
  std::vector<std::string> known{"case", "fx", "fy", "fz", "gx", "gy", "gz", "mu"};
  for (const char* prefix : {"T", "dir"}) {
    for (int k = 1; k <= tendons; ++k) known.push_back(prefix + std::to_string(k));
  }
  return known;
}

std::vector<std::string> Unused(const CsvTable& table, const std::vector<std::string>& known) {
  std::string names;
  for (const auto& column : table.columns()) {
    if (std::find(known.begin(), known.end(), column) != known.end()) continue;
    names += (names.empty() ? "'" : ", '") + column + "'";
  }
  if (names.empty()) return {};
  return {table.name() + ":1: not used: " + Excerpt(names, kShown)};
}

}  // namespace

std::vector<std::string> UnusedKeys(const Yaml& robot) {
  static const std::set<std::string> kKnown{"format",  "robot",         "length",        "diameter",
                                            "disks",   "tendons",       "tendon_radius", "E",
                                            "nu",      "density",       "disk_mass",     "mu",
                                            "gravity", "base_rotation", "calibration",   "hybrid"};
  std::vector<std::string> unused;
  for (const auto& key : robot.Keys()) {
    if (!kKnown.contains(key)) unused.push_back(robot.At(key).Where() + ": not used");
  }
  return unused;
}

std::vector<std::string> UnusedCaseColumns(const CsvTable& cases, int tendons) {
  return Unused(cases, KnownColumns(tendons));
}

std::vector<std::string> UnusedMeasuredColumns(const CsvTable& measured, int disks) {
  std::vector<std::string> known{"case", "use"};
  for (int i = 1; i <= disks; ++i) {
    for (const char* axis : {"x_", "y_", "z_"}) known.push_back(axis + std::to_string(i));
  }
  return Unused(measured, known);
}

void RejectMisspelt(const CsvTable& table, int tendons) {
  const auto known = KnownColumns(tendons);
  for (const auto& column : table.columns()) {
    if (std::find(known.begin(), known.end(), column) != known.end()) continue;
    const std::string plain = Lowered(column);
    const std::size_t letters = plain.find_first_of("0123456789");
    const bool numbered = letters != plain.npos &&
                          plain.find_first_not_of("0123456789", letters) == plain.npos &&
                          (plain.substr(0, letters) == "t" || plain.substr(0, letters) == "dir");
    const bool other_case = std::any_of(known.begin(), known.end(), [&](const std::string& name) {
      return Lowered(name) == plain;
    });
    if (!numbered && !other_case) continue;
    std::string all;
    for (const auto& name : known) all += (all.empty() ? "" : ", ") + name;
    throw Error::Input(table.name() + ":1", "columns among " + all, "'" + column + "'");
  }
}

}  // namespace continuum::tdcr
