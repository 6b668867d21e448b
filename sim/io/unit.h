#pragma once

#include <array>

namespace continuum {

/// What a unit's text says: "mm/s" is 1e-3 of the SI's unit and has the dimension m s^-1.
struct Unit {
  double factor = 1;               ///< SI value of one
  std::array<int, 4> dimension{};  ///< powers of m, kg, s, A; an angle has none
  bool any = true;  ///< made of 1, % and step alone: counts that may stand for anything
};

}  // namespace continuum
