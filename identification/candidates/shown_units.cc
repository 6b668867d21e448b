#include "identification/candidates/shown_units.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "identification/candidates/effect_places.h"
#include "identification/problem/parameter_units.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

using Names = std::vector<std::string>;

bool Has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string OutputUnit(const Names& objects, const Experiment& e) {
  for (const Output& out : e.outputs) {
    if (Has(objects, out.name())) return out.unit;
  }
  return "1";
}

std::string InSi(const std::string& unit, const std::string& where) {
  const Unit parsed = ParseUnit(unit, where);
  if (parsed.any || parsed.factor == 1) return unit;
  for (const char* const si : {"rad", "m", "N", "N*m", "Pa", "rad/s", "m/s", "V", "A"}) {
    if (parsed.Is(ParseUnit(si, where).dimension)) return si;
  }
  return "SI";
}

std::string InputUnit(const Names& objects, const Experiment& e) {
  for (const Input& in : e.inputs) {
    if (Has(objects, in.actuator)) return InSi(in.unit, in.where);
  }
  return "1";
}

// The angles of a path are those at which a cable wraps its contacts, whatever moves.
bool IsOfMotion(Place place, std::string_view unit) {
  return (place == Place::kJoint || place == Place::kTendon) && !unit.starts_with("1");
}

}  // namespace

std::map<std::string, std::string> ShownUnits(const EffectInfo& effect, Place place,
                                              const std::vector<std::string>& objects,
                                              const Experiment& e, const mjModel& m) {
  constexpr std::string_view kOutput = "output", kInput = "input";
  std::map<std::string, std::string> units;
  for (const Param& p : effect.params) {
    std::string unit(p.unit);
    if (unit.starts_with(kOutput)) {
      unit.replace(0, kOutput.size(), OutputUnit(objects, e));
    } else if (unit.starts_with(kInput)) {
      unit.replace(0, kInput.size(), InputUnit(objects, e));
    } else if (IsOfMotion(place, unit)) {
      unit = UnitOn(m, unit, PlaceName(place), GlobsOf(objects));
    }
    units[std::string(p.name)] = unit == "1" ? "" : unit;
  }
  return units;
}

}  // namespace continuum
