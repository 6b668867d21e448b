#pragma once

#include <array>
#include <string>
#include <vector>

namespace continuum {

/// What a unit's text says: "mm/s" is 1e-3 of the SI's unit and has the dimension m s^-1.
struct Unit {
  double factor = 1;               ///< SI value of one
  std::array<int, 4> dimension{};  ///< powers of m, kg, s, A; an angle has none
  bool any = true;  ///< made of 1, % and step alone: counts that may stand for anything
};

/// One factor of a unit's text: of "N*m/s^2" these are N, m and s with the powers 1, 1 and -2.
struct UnitFactorPower {
  std::string name;
  int power;
};
/// The factors of a unit's text, in its order. A name that is no unit stays as it is.
std::vector<UnitFactorPower> FactorsOf(const std::string& unit);

/// Products and quotients are understood ("N*mm", "deg/s", "mm/s^2"). where: for the Error of an
/// unknown unit.
Unit ParseUnit(const std::string& unit, const std::string& where);

/// SI value of one unit: "mm" → 1e-3, "deg" → π/180, "N*m" → 1.
double UnitFactor(const std::string& unit, const std::string& where);

/// Throws Error when a unit has another dimension than `expected` ("rad").
void RequireUnitLike(const std::string& expected, const std::string& unit,
                     const std::string& where);

}  // namespace continuum
