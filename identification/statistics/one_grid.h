#pragma once

#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// A channel of a log at the times of another one.
struct OnGrid {
  std::vector<double> value;     ///< [row of the grid]; NaN where it was not measured
  std::vector<double> variance;  ///< share of the variance of white noise that is left there
};

/// By cubic interpolation between four rows, in times from the first row on, `shift` [s] later in
/// the log than in the grid.
OnGrid Resampled(const Log& log, std::size_t channel, const Log& grid, double shift);

/// By how much a log of the same motion is late [s]: the shift, within two rows, at which all its
/// channels differ least from those of the grid.
double ShiftOf(const Log& log, const Log& grid);

}  // namespace continuum
