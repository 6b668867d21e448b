#pragma once

#include "identification/diagnosis/result.h"
#include "sim/page/page.h"

namespace continuum {

/// Adds the missing force of a joint over its angle, speed, load and time; or says that it cannot
/// be shown.
void AddMissingForce(Page& page, const MissingForce& force);

}  // namespace continuum
