#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/fit/fit.h"
#include "identification/result/uncertainty.h"

namespace continuum {

/// An uncertainty of which only at_bound is known; why: the user did not wait for it, or what
/// failed.
Uncertainty UnknownUncertainty(const Problem& problem, const Problem::Vector& x,
                               const std::string& why);
/// Extends intervals to what a fine time step would give, by a fit at a quarter of the step.
///
/// Does so where the time step moves a value by more than its standard error. Intervals reach over
/// that fit's values and AllowForSecondOrder, and further (over twice its move, and by
/// WidenByStepSize) where first order did not predict half of it. r [log], J [log][rows ×
/// parameters] and step (Problem::StepEffects): of the logs of the fit, at x; fine: makes that fit,
/// and throws Error where it diverges; u: after AllowForStep.
void ReachByFineFit(const Problem& problem, const Problem::Vector& x,
                    const std::vector<Problem::Vector>& r, const std::vector<Problem::Matrix>& J,
                    const std::vector<Problem::Matrix>& step, const FitOptions& options,
                    const std::function<Problem::Vector()>& fine, Uncertainty& u);
/// Standard errors, 95 % intervals and correlations as a fit.json states them: from the logs of the
/// fit, and of the initial state of another log from that log alone, given all else.
///
/// r: residuals [log] at x; the loss of the experiment may be robust. Derivatives are central
/// differences: one-sided ones bend what the step is said to change. Once the user has asked to
/// stop, errors, intervals and correlations are not known (NaN).
Uncertainty IntervalsOf(const Problem& problem, const Problem::Vector& x,
                        const std::vector<Problem::Vector>& r,
                        const ProgressCallback& progress = {});

}  // namespace continuum
