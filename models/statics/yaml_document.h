#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

namespace continuum::statics {

/// A number as a YAML scalar that reads back exactly; null when not finite.
YAML::Node Number(double value);
/// A list on one line.
YAML::Node List(const Eigen::VectorXd& values);
YAML::Node List(const std::vector<std::string>& values);

/// Replaces the value of a parameter, whether it stands alone or in a map with its unit. What such
/// a map said of the old value's uncertainty and source goes with it.
void SetParameter(YAML::Node& robot, const std::string& key, const YAML::Node& value,
                  const YAML::Node& uncertainty, const std::string& source);

/// The whole file or nothing.
void WriteDocument(const std::filesystem::path& path, const YAML::Node& document);

}  // namespace continuum::statics
