#pragma once

#include <vector>

#include "effects/effect.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// Values of a parameter that says of what shape an effect is, not how large: a time of creep, a
/// speed, a width, a frequency. Searches begin from each, as no fit finds its way over a decade.
struct NuisanceGrid {
  double start;                ///< the one of a first try, which is among them
  std::vector<double> values;  ///< ascending
};

/// The grid of a parameter at a place of the model: about three values per decade, but at most
/// seven, over what the logs can show. Times go from three sampling periods to the length of the
/// longest log, speeds from a hundredth of a typical one, frequencies from one over the log's
/// length to one over a sampling period, widths from a five-hundredth of the range. Of other units
/// three values: a typical size, a fifth and five times of it.
NuisanceGrid GridOf(const Param& param, Place place, const Sizes& sizes);

}  // namespace continuum
