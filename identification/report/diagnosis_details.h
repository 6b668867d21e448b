#pragma once

#include <vector>

#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/result.h"
#include "sim/page/page.h"

namespace continuum {

/// Adds what stands behind a diagnosis, folded away: all candidates with their statistics, the
/// missing force, parameters and errors, assumptions, every log before and after, and the lines of
/// the MJCF that change. Parts that cannot be made leave a badge and are added to `missing`.
void AddDetails(Page& page, const Experiment& experiment, const Diagnosis& diagnosis,
                const ExtensionRun& run, std::vector<MissingPart>& missing);

/// Adds the measured and the simulated values of the channel and log of one deviation, before and
/// after, and their differences.
void AddOverlayOf(Page& page, const Experiment& experiment, const ExtensionRun& run,
                  const Deviation& deviation);

}  // namespace continuum
