#pragma once

namespace continuum {

/// The next of 1, 2, 5 times a power of ten that is at least x; 0 where x is not above 0.
double RoundUp(double x);
/// The same, of 1, 1.5, 2, 3, 4, 5, 6, 8: for the end of a scale, of which x is two thirds or more.
double RoundUpClosely(double x);
/// The last of 1, 2, 5 times a power of ten that is at most x > 0.
double RoundDown(double x);

}  // namespace continuum
