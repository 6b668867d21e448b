#pragma once

#include <optional>
#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// Where the equations of motion hold best along what was measured.
struct EquationFit {
  Problem::Vector x;
  std::size_t evaluations = 0;  ///< logs that the model was driven along
};

/// Parameters with which, along the measured motion, the missing forces f (missing_force.h) are
/// least, and from there the accelerations a that are missing, each joint j in units of its own at
/// the start,
///
///   min Σ_j Σ_rows f_j² / |f_j|²,   then   min Σ_j Σ_rows a_j² / |a_j|²
///
/// No simulation drifts in them, and most parameters enter f linearly: this cost has one minimum
/// where that of the motion has many. But inertias multiply the noise of measured accelerations,
/// which draws them down; to a it is only added. A start for a fit, no more, as differences of
/// measured rows hold less than the motion does. Outliers spoil it, under a robust loss
/// too. Parameters that neither sees stay at x. Logs count in which every joint is measured in all
/// rows; nothing where there is none.
std::optional<EquationFit> FitEquations(const Problem& problem, const Problem::Vector& x,
                                        const std::vector<bool>& use);

/// A fit, or where it leaves far more than the measurement noise and three tenths of the motion
/// itself, as when it ended out of step, and the motion fits better with those parameters, one that
/// begins there, in the iterations that are left. Its iterations and trace are its own, its effort
/// that of all.
Fit FitByEquations(const Problem& problem, Fit best, const std::vector<bool>& use,
                   const FitOptions& options);

}  // namespace continuum
