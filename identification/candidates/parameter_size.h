#pragma once

#include "effects/effect.h"
#include "identification/candidates/typical_sizes.h"

namespace continuum {

/// How large a parameter of an effect may be expected to be, so that a search knows where to look.
struct ParameterSize {
  double size;            ///< [unit of the parameter]
  double reach = 3;       ///< bounds of the search lie so many sizes from the null value
  double typical = 0.05;  ///< the search begins so many sizes from it
};

/// The size of a parameter at a place of the model, from the powers in its unit and the typical
/// sizes of an experiment. Angles and torques of a tendon are its lengths and tensions. Throws
/// Error for a unit that is not made of 1, N, J, m, kg, s, rad and input.
ParameterSize SizeOf(const Param& param, Place place, const Sizes& sizes);

/// The same for a law of a cable's contacts, whose angles are those by which the cable wraps them.
ParameterSize SizeAlongCable(const Param& param, const Sizes& sizes);

}  // namespace continuum
