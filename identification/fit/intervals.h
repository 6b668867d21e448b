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
/// Where the time step moves a value by more than its standard error, a fit at a quarter of the
/// step, from x, tells what a fine one gives: intervals are made anew to reach over that, and
/// further (over twice its move, and by ReachFurther) where first order did not foretell half of
/// it. r, J, step: of the logs of the fit, as above; u: after AllowForStep.
void ReachByFineFit(const Problem& problem, const Problem::Vector& x,
                    const std::vector<Problem::Vector>& r, const std::vector<Problem::Matrix>& J,
                    const std::vector<Problem::Matrix>& step, const FitOptions& options,
                    Uncertainty& u);
/// All of these in one, from the logs of the fit; of where another log begins from that log alone,
/// given all else: what a fit.json states. r: residuals at x; the loss of the experiment may be
/// robust. Derivatives are central differences: one-sided ones bend what the step is said to
/// change. Once the user has asked to stop, errors, intervals and correlations are not known (NaN).
Uncertainty IntervalsOf(const Problem& problem, const Problem::Vector& x,
                        const std::vector<Problem::Vector>& r,
                        const std::function<void(const std::string&)>& progress = {});

}  // namespace continuum
