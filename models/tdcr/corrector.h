#pragma once

#include "sim/numerics/solver.h"

namespace continuum::tdcr {

/// Of Newton's method for a root of the balances.
inline numerics::Options Limits() {
  numerics::Options options;
  options.tolerance = 1e-12;
  options.accept = 5e-10;
  options.max_step = 6;  // radians over the whole rod
  return options;
}

/// That gives up where it would leave the neighbourhood, on the way of a rising load.
inline numerics::Options Corrector(double load) {
  constexpr double kOnTheWay = 1e-8;  // of EI/L
  numerics::Options options = Limits();
  if (load < 1) options.tolerance = kOnTheWay;
  options.damped = false;
  options.max_iterations = 12;
  return options;
}

}  // namespace continuum::tdcr
