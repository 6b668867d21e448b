#include "hidden_effects/families.h"

#include <algorithm>

namespace continuum::hidden {
namespace {

const std::vector<std::vector<std::string>>& Families() {
  static const std::vector<std::vector<std::string>> all{
      {"coulomb", "dahl", "lugre", "bouc_wen", "stribeck"},
      {"dead_time", "sensor_delay", "pt1", "pt2"},
      {"payload", "link_mass", "armature"}};
  return all;
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> FamilyOf(const std::string& effect) {
  for (const auto& family : Families()) {
    if (Has(family, effect)) return family;
  }
  return {effect};
}

bool IsDryFriction(const std::string& effect) { return Has(Families().front(), effect); }

}  // namespace continuum::hidden
