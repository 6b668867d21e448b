#pragma once

#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Throws Error, naming both, when two free parameters do the same to the same attribute of the
/// same elements: only their product, their sum or the later one would count. One of all joints and
/// one of a single joint may stand together; so may different operations.
void RefuseDuplicates(const std::vector<Parameter>& parameters, const ModelSpec& system);

}  // namespace continuum
