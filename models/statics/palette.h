#pragma once

#include <cstddef>
#include <vector>

#include "models/statics/canvas.h"

namespace continuum::statics {

/// Colour and dashes of case `index`: 28 cases differ by colour, by dashes or both, so that they
/// can be distinguished by colour-blind readers and in a grey print. Colours of Okabe and Ito,
/// "Color universal design", 2008, without their yellow.
Pen CasePen(std::size_t index);

/// Dark blue at 0 to yellow at 1, even steps in lightness (viridis, van der Walt and Smith, 2015).
Colour Viridis(double share);

}  // namespace continuum::statics
