#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/check/findings.h"
#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// What the logs say by themselves: clock, duplicated rows, missing, stale, repeated, jumping,
/// clipped and constant columns, quantisation, columns that copy another, velocities that are not
/// the derivative of their position, lags from inputs to outputs, excitation, replicates, split and
/// what such an experiment cannot determine.
std::vector<Finding> CheckLogs(const Experiment& e);

/// What a simulation of each log makes suspect: units, signs, swapped columns, shifts in time and
/// offsets at rest. The model need not be right, only right enough to be recognised; what a wrong
/// model and a wrong column would both explain is worded so. Throws Error for names that the model
/// does not have.
std::vector<Finding> CheckAgainstModel(const Experiment& e, const ModelSpec& system);

/// For a terminal: a summary, then what the logs have in common, what columns of one log have in
/// common as one line, the rest under its log.
std::string Report(const std::vector<Finding>& findings);

/// For a terminal: a summary, then one line per finding under its log.
std::string FullReport(const std::vector<Finding>& findings);

/// A list of objects with the members of Finding, severity as "info", "warning" or "error".
nlohmann::json ToJson(const std::vector<Finding>& findings);

}  // namespace continuum
