#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "identification/problem/problem.h"

namespace continuum {

/// The extended model as files: model (the hypothesis' system with its fitted values) and the
/// experiment that belongs to it. Values that logs set themselves are written as
/// they are after the fit, so that both files together simulate what was fitted.
struct Extension {
  std::string xml, yaml;
};
Extension Extend(const Problem& problem, const Problem::Vector& x,
                 const std::filesystem::path& folder, const std::string& model = "extended.xml");

/// A plugin instance that an extension adds (native effects have none: no effect), and the name of
/// the one whose place it takes, if any.
struct Added {
  EffectInstance instance;
  std::string replaces;
};
/// What was changed, for `continuum apply`: {instances: [{effect, name, config, replaces}],
/// changes}.
nlohmann::json ChangesJson(const Problem& problem, const Problem::Vector& x,
                           const std::vector<Added>& added);
/// Applies ChangesJson to another model and returns its MJCF, to be written into a folder (empty:
/// beside the model). where: the file of the JSON. Throws Error with file and key.
std::string ApplyJson(const ModelSpec& system, const nlohmann::json& json, const std::string& where,
                      const std::filesystem::path& folder = {});

/// Lines that differ between two texts, with "-" and "+" in front, as a minimal line diff.
std::string LineDiff(const std::string& before, const std::string& after);

}  // namespace continuum
