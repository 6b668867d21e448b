#include "sim/model/attribute_bounds.h"

#include <array>
#include <string_view>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

// An attribute, of one kind of element or of all that have it, that zero bounds from below.
struct Bounded {
  std::string_view kind, attribute, unit;
  bool zero = true;  ///< whether zero itself is possible
};

constexpr std::array kBounded{Bounded{"body", "mass", "kg"},
                              Bounded{"body", "point_mass", "kg"},
                              Bounded{"body", "inertia", "kg*m^2"},
                              Bounded{"geom", "mass", "kg"},
                              Bounded{"", "density", "kg/m^3"},
                              Bounded{"", "armature", "kg*m^2 (turning) or kg"},
                              Bounded{"", "damping", "N*m*s/rad (turning) or N*s/m"},
                              Bounded{"", "frictionloss", "N*m (turning) or N"},
                              Bounded{"actuator", "delay", "s"},
                              Bounded{"actuator", "lag", "s"},
                              Bounded{"option", "viscosity", "Pa*s"},
                              Bounded{"option", "timestep", "s", false}};

// Of a vector only mass-like ones are bounded in every component: "damping" is "damping[0]", what
// follows are the coefficients of a polynomial.
bool Names(const Bounded& b, std::string_view attribute) {
  if (attribute == b.attribute) return true;
  if (!attribute.starts_with(b.attribute) || attribute[b.attribute.size()] != '[') return false;
  return b.attribute == "inertia" || attribute.ends_with("[0]");
}

}  // namespace

void RequirePossible(const Change& change) {
  const std::string_view kind = std::string_view(change.target).substr(0, change.target.find(':'));
  for (const Bounded& b : kBounded) {
    if (!b.kind.empty() && b.kind != kind) continue;
    if (kind == "plugin" || !Names(b, change.attribute)) continue;
    if (b.zero ? change.value >= 0 : change.value > 0) continue;
    throw Error::Input(
        change.target + ": " + change.attribute,
        std::string(b.zero ? "a number >= 0 " : "a number > 0 ") + std::string(b.unit),
        Decimal(change.value));
  }
}

}  // namespace continuum
