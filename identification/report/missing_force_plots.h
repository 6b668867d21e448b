#pragma once

#include "identification/diagnosis/result.h"
#include "sim/page/page.h"

namespace continuum {

/// Adds the missing force of a joint over its angle, speed, load and time; or says that it cannot
/// be shown.
void AddMissingForce(Page& page, const MissingForce& force);

/// Adds the force that is missing without a law, and the law, over what the formula depends on.
void AddLaw(Page& page, const LawPicture& picture, const std::string& formula);

}  // namespace continuum
