#pragma once

#include <string>

#include "identification/result/derivatives.h"

namespace continuum {

/// A line for each parameter: how its derivative is made, and why not in closed form. Where logs
/// differ, a line for each kind, with its logs.
std::string DerivativesInWords(const Derivatives& all);

}  // namespace continuum
