#pragma once

#include <array>

namespace continuum {

/// What a unit's text says: "mm/s" is 1e-3 of the SI's unit and has the dimension m s^-1.
struct Unit {
  double factor = 1;               ///< SI value of one
  std::array<int, 4> dimension{};  ///< powers of m, kg, s, A; an angle has none
  bool any = true;  ///< made of 1, % and step alone: counts that may stand for anything

  /// Whether it is one of this dimension and no count.
  bool Is(const std::array<int, 4>& other) const { return !any && dimension == other; }
  bool IsAngle() const { return Is({}); }
};

}  // namespace continuum
