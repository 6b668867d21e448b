#pragma once

#include "sim/experiment/experiment.h"

namespace continuum {

/// Whether two logs are one trial recorded twice: same trial, condition, times (from the first row
/// on) and inputs. Noise is what is measured differently in them.
bool AreReplicates(const Log& a, const Log& b);

/// The same where clocks or inputs differ a little, as those of real loggers do: other row times,
/// a tenth longer or shorter, and inputs that come up to two rows apart and then differ by up to
/// 5 % of what they move.
bool AreNearReplicates(const Log& a, const Log& b);

}  // namespace continuum
