#pragma once

#include "identification/problem/problem.h"
#include "identification/result/regression.h"

namespace continuum {

struct RegressorOptions {
  double cutoff = 0;  ///< of the low-pass [Hz]; 0: 50 Hz, or a fifth of the sampling rate
};

/// Least squares on the inverse dynamics of parameters that enter linearly:
///
///   F [ID(q, v, a; p) − Bᵀ f] = 0,   ID = M a + c − (passive forces and dry friction)
///
/// at measured q, with v and a as its derivatives; f are measured actuator forces, or what the
/// model gives under the logged inputs. F low-passes positions first and then both sides, without
/// phase (gautier1997, janot2014). Each joint's equation is weighted by its RMS force; where dry
/// friction may hold the joint it is left out (MarkStationary), but counts in the errors. No
/// simulation: a start is not needed, but every joint (hinge or slide) must be measured, evenly in
/// time; those that linear joint equalities tie to others follow them (Ties).
///
/// Throws Error for joints that are not measured, states that cannot be (activations, laws with
/// states, cable friction), parameters that do not enter linearly, or that nothing determines.
Regression FitByRegressor(const Problem& problem, const std::vector<bool>& use,
                          const RegressorOptions& options = {});

}  // namespace continuum
