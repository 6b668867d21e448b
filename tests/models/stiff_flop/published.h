#pragma once

#include "models/stiff_flop/forward.h"

namespace continuum::stiff_flop {

/// The module of the paper.
inline Module Published() {
  return {2.5e-3, 3e-3, 1.5599752854, 9e-3, 4.5e-3, 12.5e-3, 44e-3, 16.6e-3, 1e5, 24e-3, 1e-3, 1};
}

}  // namespace continuum::stiff_flop
