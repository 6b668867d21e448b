#pragma once

#include <optional>
#include <string>

#include "identification/fit/fit.h"
#include "identification/result/shooting_segments.h"

namespace continuum {

/// Rows first to last of a log, both included.
Log SegmentOf(const Log& log, std::size_t first, std::size_t last);

/// Fits long logs in segments first, by multiple shooting (bock1984).
///
/// Over a long log a small error of a parameter adds up until the simulation is out of phase with
/// the measurement: the cost has many local minima, and a fit ends in the first. So logs of more
/// than 20 s are cut into overlapping segments with initial states of their own (start: estimate,
/// identification/problem/start_parameters.h): first 64, none of which gets out of phase, then 16,
/// which determine the parameters better. The ends of these are drawn together,
///
///   Σ r² + w² Σ (r_k − r_{k+1})²,   w = 0, 1, 10, 100,
///
/// the second sum over the rows that segment k shares with the next: all that outputs see there,
/// positions and speeds. w → ∞ is the fit of the whole log from the start of its first segment.
///
/// Returns the best for whole logs of x and these ends. Nothing where no log in use is long, rows
/// have no time, parameters belong to single logs, joints are not hinges and slides with names, or
/// the starts are too many.
std::optional<ShootingSegments> FitByMultipleShooting(const Problem& problem,
                                                      const Problem::Vector& x,
                                                      const std::vector<bool>& use,
                                                      const FitOptions& options);

}  // namespace continuum
