#pragma once

#include "sim/experiment/experiment.h"

namespace continuum {

/// Whether two logs are one trial recorded twice: same trial, condition, times (from the first row
/// on) and inputs. Noise is what is measured differently in them.
bool AreReplicates(const Log& a, const Log& b);

}  // namespace continuum
