#pragma once

#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// Spread B of a normal distribution around a fit by whose points the cost doubles on average, as
/// the slopes J at it say (FitOptions::slopes), and in no direction further than the parameters'
/// sizes:
///
///   B Bᵀ = (JᵀJ n / 2C + I)⁻¹
///
/// It is long along a valley, in which a parameter is hardly seen.
Problem::Matrix SpreadOf(const Fit& fit, const Problem::Matrix& J);

/// Whether the cost around a fit has ripples, as where a machine sticks and slips: over a step that
/// moves the residuals by a tenth, slopes J predict a third of the move wrong, or more.
bool HasRipples(const Problem& problem, const Fit& fit, const Problem::Matrix& J,
                const std::vector<bool>& use, const FitOptions& options);

}  // namespace continuum
