#pragma once

#include <string>

namespace continuum {

/// SI value of one unit: "mm" → 1e-3, "deg" → π/180, "N*m" → 1. Products and quotients are
/// understood ("N*mm", "deg/s", "mm/s^2"). where: for the Error of an unknown unit.
double UnitFactor(const std::string& unit, const std::string& where);

}  // namespace continuum
