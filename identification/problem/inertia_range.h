#pragma once

#include <vector>

#include "identification/result/free_parameter.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Keeps a principal inertia that is free alone of its body's three to what a body can have,
///
///   |I_j − I_k| ≤ I_i ≤ I_j + I_k,
///
/// where the model holds to it (<compiler balanceinertia> does not). Beyond that no machine
/// compiles, and a fit would end without a word. A bound that moves says why
/// (FreeParameter::why_upper). A start beyond stays there, for RequireStartModels to name.
void KeepToInertias(const ModelSpec& system, std::vector<FreeParameter>& parameters);

}  // namespace continuum
