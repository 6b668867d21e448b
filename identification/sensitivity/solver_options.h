#pragma once

namespace continuum {

/// The method of CVODES and the errors of one step that it accepts, of the states y and of every
/// sensitivity s_k [units of y]: Adams formulas with fixed-point iterations, or, for stiff
/// equations, BDF with Newton iterations.
struct SolverOptions {
  double relative = 1e-6, absolute = 1e-8;
  bool stiff = true;
};

}  // namespace continuum
