#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// The channels of an experiment, in its order; by them diagnoses of the same robot are known.
std::vector<std::string> ChannelNames(const Experiment& experiment);

/// All of a diagnosis.json but for the list of what is missing. Parts that cannot be made are null
/// and are added to `missing`.
nlohmann::json DiagnosisJson(const Experiment& experiment, const Diagnosis& diagnosis,
                             const ExtensionRun& run, std::vector<MissingPart>& missing);

}  // namespace continuum
