#pragma once

#include <string>
#include <vector>

#include "sim/io/unit.h"

namespace continuum {

/// One factor of a unit's text: of "N*m/s^2" these are N, m and s with the powers 1, 1 and -2.
struct UnitFactorPower {
  std::string name;
  int power;
};
/// The factors of a unit's text, in its order; a number is a factor too ("60" in "60 s"). A name
/// that is no unit stays as it is, and so does the whole of a text that is no product.
std::vector<UnitFactorPower> FactorsOf(const std::string& unit);

/// Products and quotients are understood as UDUNITS-2 writes them: "N*mm", "N.m", "N m", "N·m",
/// "deg/s", "mm/s^2", "m s-2", "N/(m s)", "rad per second". Names: UnitNamed (sim/io/unit_names.h).
/// UDUNITS-2 itself would need its file of names at run time, and does not know "Nm", "deg",
/// "step". where: for the Error of an unknown unit.
Unit ParseUnit(const std::string& unit, const std::string& where);

/// SI value of one unit: "mm" → 1e-3, "deg" → π/180, "N*m" → 1.
double UnitFactor(const std::string& unit, const std::string& where);

/// Throws Error when a unit has another dimension than `expected` ("rad").
void RequireUnitLike(const std::string& expected, const std::string& unit,
                     const std::string& where);

}  // namespace continuum
