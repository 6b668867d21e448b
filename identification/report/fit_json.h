#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "identification/result/identify_result.h"

namespace continuum {

/// All of a fit.json but for the list of what is missing. Parts that cannot be made are added to
/// `missing`.
nlohmann::json FitJson(const Experiment& experiment, const IdentifyResult& result,
                       std::vector<MissingPart>& missing);

/// The parameters of a fit with the values x: [{name, unit, value, standard_error, ci95, lower,
/// upper, start, at_bound, start_at_bound}], and fine_step, the value that a fine time step would
/// give, where that is known. Throws Error where the uncertainty has other parameters.
nlohmann::json ParametersJson(const std::vector<FreeParameter>& parameters,
                              const Eigen::VectorXd& x, const Uncertainty& uncertainty);

}  // namespace continuum
