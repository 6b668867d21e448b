#pragma once

#include <string>

#include "identification/result/identify_result.h"

namespace continuum {

/// What the terminal says of a fit: a line for each parameter, the errors, what the logs do not
/// determine, and where the report is.
std::string FitSummary(const Experiment& experiment, const IdentifyResult& result,
                       const std::string& folder);

}  // namespace continuum
