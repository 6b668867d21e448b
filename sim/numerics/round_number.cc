#include "sim/numerics/round_number.h"

#include <cmath>
#include <initializer_list>

namespace continuum {
namespace {

double Power(double x) { return std::pow(10, std::floor(std::log10(x))); }

double NextOf(std::initializer_list<double> digits, double x) {
  if (!(x > 0)) return 0;
  const double power = Power(x);
  for (const double digit : digits) {
    if (digit * power >= x) return digit * power;
  }
  return 10 * power;
}

}  // namespace

double RoundUp(double x) { return NextOf({1, 2, 5}, x); }

double RoundUpClosely(double x) { return NextOf({1, 1.5, 2, 3, 4, 5, 6, 8}, x); }

double RoundDown(double x) {
  const double power = Power(x);
  for (const double digit : {5, 2}) {
    if (digit * power <= x) return digit * power;
  }
  return power;
}

}  // namespace continuum
