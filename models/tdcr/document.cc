#include "models/tdcr/document.h"

namespace continuum::tdcr {

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

}  // namespace continuum::tdcr
