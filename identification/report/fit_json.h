#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "identification/result/free_parameter.h"
#include "identification/result/uncertainty.h"

namespace continuum {

/// The parameters of a fit with the values x: [{name, unit, value, standard_error, ci95, lower,
/// upper, start, at_bound, start_at_bound}], and fine_step, the value that a fine time step would
/// give, where that is known.
nlohmann::json ParametersJson(const std::vector<FreeParameter>& parameters,
                              const Eigen::VectorXd& x, const Uncertainty& uncertainty);

}  // namespace continuum
