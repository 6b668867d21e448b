#pragma once

#include <optional>
#include <string>

#include "identification/fit/fit.h"
#include "identification/result/shooting_segments.h"

namespace continuum {

/// Rows first to last of a log.
Log Piece(const Log& log, std::size_t first, std::size_t last);

/// Multiple shooting (bock1984). Over a long log a small error of a parameter adds up until the
/// simulation is out of step with the measurement: the cost is full of valleys, and a fit ends in
/// the first. So logs of more than 20 s are cut into pieces that overlap and begin where they like
/// (start: estimate, identification/problem/start_parameters.h): first 64, of which no simulation
/// falls out of step, then 16, which tell more and whose ends are drawn together,
///
///   Σ r² + w² Σ (r_k − r_{k+1})²,   w = 0, 1, 10, 100,
///
/// the second sum over the rows that a piece shares with the next: all that outputs see there,
/// positions and speeds. w → ∞ is the fit of the whole log, from the start of its first piece.
/// Returns the best for whole logs of x and these ends. Nothing where no log in use is long, rows
/// know no time, parameters belong to single logs, joints are not hinges and slides with names, or
/// the starts are too many.
std::optional<ShootingSegments> FitInPieces(const Problem& problem, const Problem::Vector& x,
                                            const std::vector<bool>& use,
                                            const FitOptions& options);

}  // namespace continuum
