#include "sim/model/attribute_bounds.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/model/native_effect.h"

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

constexpr double kMost = 1e12;  // SI: the stiffest and the strongest machine is far below

struct Limits {
  double least = -kMost, most = kMost;
  bool open = false;  ///< whether `least` itself is excluded
  std::string_view unit = "";
};

Limits OfCard(const Param& p) {
  const bool positive = p.lower == std::numeric_limits<double>::min();
  return {positive ? 0 : std::max(p.lower, -kMost),
          p.null == kInfinity ? kInfinity : std::min(p.upper, kMost), positive, p.unit};
}

Limits LimitsOf(const Change& change) {
  if (IsNativeEffect(change)) return OfCard(ParameterOfNativeEffect(change.attribute));
  const std::string_view kind = std::string_view(change.target).substr(0, change.target.find(':'));
  for (const Bounded& b : kBounded) {
    if (!b.kind.empty() && b.kind != kind) continue;
    if (kind != "plugin" && Names(b, change.attribute)) return {0, kMost, !b.zero, b.unit};
  }
  const bool range = change.attribute.find("range") != change.attribute.npos;
  return range ? Limits{-kInfinity, kInfinity} : Limits{};
}

// A factor of what is never negative is not either.
Limits OfOperation(const Limits& value, Change::Operation operation) {
  if (operation == Change::Operation::kSet) return value;
  const bool factor = operation == Change::Operation::kScale;
  return {factor && value.least == 0 ? 0 : -kMost, kMost};
}

}  // namespace

void RequirePossible(const Change& change) {
  const Limits limits = OfOperation(LimitsOf(change), change.operation);
  const auto require = [&](bool holds, const std::string& sign, double limit) {
    if (holds) return;
    std::string expected = "a number " + sign + " " + Decimal(limit);
    if (!limits.unit.empty() && limits.unit != "1") expected += " " + std::string(limits.unit);
    throw Error::Input(change.target + ": " + change.attribute, expected, Decimal(change.value));
  };
  if (limits.open) require(change.value > limits.least, ">", limits.least);
  require(change.value >= limits.least, ">=", limits.least);
  require(change.value <= limits.most, "<=", limits.most);
}

}  // namespace continuum
