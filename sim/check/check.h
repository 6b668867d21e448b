#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// Something worth knowing about a log before anything is fitted to it.
struct Finding {
  /// kInfo describes, kWarning is a likely defect, kError makes a result worthless.
  enum class Severity { kInfo, kWarning, kError };

  std::string log;      ///< label; empty: the whole experiment
  std::string channel;  ///< column; empty: the whole log
  std::string what;     ///< kind in snake_case: "gap", "stale", "unit_suspect", …
  std::string text;     ///< one plain sentence with numbers and units
  std::string gist;     ///< text without the list of further places at its end
  double begin = 0;     ///< [s] where it is; the whole log when it is everywhere
  double end = 0;       ///< [s]
  Severity severity = Severity::kInfo;
};

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
