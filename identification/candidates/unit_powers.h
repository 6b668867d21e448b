#pragma once

#include <map>
#include <string>
#include <string_view>

namespace continuum {

/// The powers of a unit's factors: N*m/rad^3 is {N: 1, m: 1, rad: -3}. A joule is N*m, and 1 is no
/// factor. Throws Error for what is no unit.
using Powers = std::map<std::string, int>;
Powers PowersOf(std::string_view unit);

}  // namespace continuum
