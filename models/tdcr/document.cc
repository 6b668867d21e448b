#include "models/tdcr/document.h"

#include <cmath>

#include "sim/io/decimal.h"
#include "sim/io/file.h"

namespace continuum::tdcr {

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

YAML::Node Document(const Spread& spread) {
  YAML::Node node;
  node["mean"] = Number(spread.mean);
  node["std"] = Number(spread.std);
  node["min"] = Number(spread.min);
  node["max"] = Number(spread.max);
  node.SetStyle(YAML::EmitterStyle::Flow);
  return node;
}

YAML::Node Document(const TipErrors& errors) {
  YAML::Node node(YAML::NodeType::Map);
  if (const auto spread = Statistics(errors.train)) node["train"] = Document(*spread);
  if (const auto spread = Statistics(errors.test)) node["test"] = Document(*spread);
  return node;
}

void WriteDocument(const std::filesystem::path& path, const YAML::Node& document) {
  YAML::Emitter text;
  text << document;
  WriteFile(path, std::string(text.c_str()) + "\n");
}

}  // namespace continuum::tdcr
