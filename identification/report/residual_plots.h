#pragma once

#include <vector>

#include "sim/page/page.h"
#include "sim/replay/replay.h"

namespace continuum {

/// Adds plots of the residuals of all logs that do not diverge, for each of these channels of the
/// experiment: autocorrelation (each log, or the mean and the range of more logs than the page has
/// colours), a table of how long residuals stay correlated [s], and residuals over every input with
/// their mean by classes of the input.
void AddResiduals(Page& page, const Experiment& experiment,
                  const std::vector<std::size_t>& channels, const std::vector<Replayed>& logs);

}  // namespace continuum
