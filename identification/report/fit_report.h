#pragma once

#include <vector>

#include "identification/result/free_parameter.h"
#include "identification/result/uncertainty.h"
#include "sim/page/page.h"

namespace continuum {

/// Adds a table of the parameters of a fit with the values x, their standard errors and intervals;
/// without the starts of trials.
void AddParameterTable(Page& page, const std::vector<FreeParameter>& parameters,
                       const Eigen::VectorXd& x, const Uncertainty& uncertainty);

}  // namespace continuum
