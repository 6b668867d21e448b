#pragma once

#include <cstdint>
#include <optional>

#include "identification/fit/fit.h"
#include "identification/result/multi_start.h"
#include "identification/result/shooting_segments.h"

namespace continuum {

/// How far a search for the best fit looks around.
struct FitSearch {
  int starts = 1;          ///< from the given start, and from random ones
  std::uint64_t seed = 1;  ///< of those
  bool segments = true;    ///< long logs in segments first
};

/// A fit, and what was tried for it.
struct SearchedFit {
  Fit fit;
  std::optional<ShootingSegments> segments;  ///< of long logs, fitted before the whole
  std::optional<MultiStart> starts;          ///< where there were several
};

/// Fits whole logs from x by everything that leads out of a wrong local minimum, one after the
/// other: segments of long logs (fit/multiple_shooting.h), slopes over a fifth of the parameters
/// (fit/wide_slope_fit.h) or random starts, where the motion is still out of step the equations of
/// motion (equation_error_fit.h), and short horizons (short_horizon.h). `identify` and `diagnose`
/// both begin with it. Throws Error as FitParameters does.
SearchedFit FitBySearch(const Problem& problem, const Problem::Vector& x,
                        const std::vector<bool>& use, const FitSearch& search,
                        const FitOptions& options);

}  // namespace continuum
