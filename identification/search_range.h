#pragma once

#include <string>

#include "effects/effect.h"
#include "identification/sizes.h"

namespace continuum {

/// A parameter of a candidate, free within bounds and from an initial value that its unit and the
/// sizes of the experiment suggest.
Parameter FreeOne(const Param& p, Place place, const Sizes& sizes, const std::string& target,
                  const std::string& attribute, Change::Operation operation);

}  // namespace continuum
