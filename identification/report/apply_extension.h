#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/model/change.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// A plugin instance that an extension adds (native effects have none: no effect), and the name of
/// the one whose place it takes, if any.
struct Added {
  EffectInstance instance;
  std::string replaces;
};
/// What an extension changes, for `continuum apply`: {instances: [{effect, name, config,
/// replaces}], changes: [{target, attribute, value, operation}]}.
nlohmann::json ChangesJson(const std::vector<Change>& changes, const std::vector<Added>& added);
/// Applies ChangesJson to another model and returns its MJCF, to be written into a folder (empty:
/// beside the model). where: the file of the JSON. Throws Error with file and key.
std::string ApplyJson(const ModelSpec& system, const nlohmann::json& json, const std::string& where,
                      const std::filesystem::path& folder = {});

}  // namespace continuum
