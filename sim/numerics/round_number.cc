#include "sim/numerics/round_number.h"

#include <cmath>
#include <initializer_list>

namespace continuum {
namespace {

double Power(double x) { return std::pow(10, std::floor(std::log10(x))); }

}  // namespace

double RoundUp(double x) {
  if (!(x > 0)) return 0;
  const double power = Power(x);
  for (const double digit : {1, 2, 5}) {
    if (digit * power >= x) return digit * power;
  }
  return 10 * power;
}

double RoundDown(double x) {
  const double power = Power(x);
  for (const double digit : {5, 2}) {
    if (digit * power <= x) return digit * power;
  }
  return power;
}

}  // namespace continuum
