#pragma once

#include <limits>

namespace continuum {

/// The method of CVODES and the errors of one step that it accepts, of the states y and of every
/// sensitivity s_k [units of y]: Adams formulas with fixed-point iterations, or, for stiff
/// equations, BDF with Newton iterations. A simulation ends at the first row that takes more than
/// most_rates evaluations of the motion.
struct SolverOptions {
  double relative = 1e-6, absolute = 1e-8;
  bool stiff = true;
  long most_rates = std::numeric_limits<long>::max();
};

}  // namespace continuum
