#pragma once

#include <optional>
#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// The same problem, simulated anew from the measured state every eighth of a log.
///
/// Where a swing is out of step with the measured one, as beyond a whole turn that it did not make,
/// the cost of free simulation has many local minima; over short horizons nothing gets there. At
/// their beginnings positions and speeds of the joints are those of a quartic through the measured
/// rows (measured_motion.h); activations and states of effects go on as they are, so that lags and
/// hysteresis remember. By steps, whatever the path. Nothing where a log in use does not measure
/// every joint.
std::optional<Problem> OnShortHorizons(const Problem& problem, const std::vector<bool>& use);

/// A fit or, where it is out of step (identification/fit/out_of_step.h), a better one that begins
/// at the best parameters over short horizons, if there is one. anew is set then; its effort is
/// that of all.
Fit FitByShortHorizons(const Problem& problem, Fit best, const std::vector<bool>& use,
                       const FitOptions& options);

/// Where a fit is out of step still, as of a double pendulum that is let go from the top, no cost
/// of whole logs tells parameters from others. If some follow the logs over short horizons, they
/// take its place, and over_pieces is set.
void FitOverPieces(const Problem& problem, const std::vector<bool>& use, const FitOptions& options,
                   Fit& fit);

}  // namespace continuum
