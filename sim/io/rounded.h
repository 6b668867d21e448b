#pragma once

#include <string>

/// Numbers as people read them: what rounds to zero has no sign.
namespace continuum {

/// With so many digits behind the point: "0.50", "-1", "0" (of -0.3, with none).
std::string Fixed(double value, int digits);

/// With so many significant digits at most: "0.5", "-1e+03", "0" (of -0.0).
std::string Significant(double value, int digits);

/// A share in per cent: "64 %" of 0.643, "-6.4 %" of -0.0643 with one digit.
std::string Percent(double share, int digits = 0);

}  // namespace continuum
