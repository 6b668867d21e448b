#include "models/statics/yaml_document.h"

#include <cmath>

#include "sim/io/decimal.h"
#include "sim/io/file.h"

namespace continuum::statics {

YAML::Node Number(double value) {
  return std::isfinite(value) ? YAML::Node(Decimal(value)) : YAML::Node(YAML::NodeType::Null);
}

YAML::Node List(const Eigen::VectorXd& values) {
  YAML::Node list(YAML::NodeType::Sequence);
  for (const double value : values) list.push_back(Number(value));
  list.SetStyle(YAML::EmitterStyle::Flow);
  return list;
}

YAML::Node List(const std::vector<std::string>& values) {
  YAML::Node list(YAML::NodeType::Sequence);
  for (const auto& value : values) list.push_back(value);
  list.SetStyle(YAML::EmitterStyle::Flow);
  return list;
}

void SetParameter(YAML::Node& robot, const std::string& key, const YAML::Node& value,
                  const YAML::Node& uncertainty, const std::string& source) {
  if (!robot[key].IsDefined() || !robot[key].IsMap()) {
    robot[key] = value;
    return;
  }
  YAML::Node parameter = robot[key];
  parameter["value"] = value;
  parameter["uncertainty"] = uncertainty;
  parameter["source"] = source;
}

void WriteDocument(const std::filesystem::path& path, const YAML::Node& document) {
  YAML::Emitter text;
  text << document;
  WriteFile(path, std::string(text.c_str()) + "\n");
}

}  // namespace continuum::statics
