#include "identification/report/apply_extension.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/model/attribute_bounds.h"

namespace continuum {
namespace {

// A value of a JSON file that knows where it stands: every error names file and key.
class Json {
 public:
  Json(const nlohmann::json& value, std::string file, std::string path = "")
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  Json At(const std::string& key) const {
    if (!value_->is_object()) Refuse("a map with '" + key + "'");
    if (!value_->contains(key)) throw Error::Input(Where(), "the key '" + key + "'", "none");
    return {(*value_)[key], file_, path_.empty() ? key : path_ + "." + key};
  }
  std::vector<Json> Items() const {
    if (!value_->is_array()) Refuse("a list");
    std::vector<Json> items;
    for (std::size_t i = 0; i < value_->size(); ++i)
      items.push_back({(*value_)[i], file_, path_ + "[" + std::to_string(i) + "]"});
    return items;
  }
  std::string Text() const {
    if (!value_->is_string()) Refuse("a text");
    return value_->get<std::string>();
  }
  double Number() const {
    if (!value_->is_number() || !std::isfinite(value_->get<double>())) Refuse("a finite number");
    return value_->get<double>();
  }
  [[noreturn]] void Refuse(const std::string& expected) const {
    constexpr std::size_t kShown = 60;
    std::string found = value_->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    if (found.size() > kShown) found = found.substr(0, kShown) + "...";
    throw Error::Input(Where(), expected, found);
  }

 private:
  std::string Where() const { return path_.empty() ? file_ : file_ + ": " + path_; }

  const nlohmann::json* value_;
  std::string file_, path_;
};

Change ReadChange(const Json& json) {
  Change change{json.At("target").Text(), json.At("attribute").Text(), json.At("value").Number(),
                Change::Operation::kSet};
  const Json operation = json.At("operation");
  const std::string name = operation.Text();
  if (name == "scale") {
    change.operation = Change::Operation::kScale;
  } else if (name == "add") {
    change.operation = Change::Operation::kAdd;
  } else if (name != "set") {
    operation.Refuse("set | scale | add");
  }
  return change;
}

EffectInstance ReadInstance(const Json& json) {
  EffectInstance instance{json.At("effect").Text(), json.At("name").Text(), {}};
  for (const Json& pair : json.At("config").Items()) {
    const auto both = pair.Items();
    if (both.size() != 2) pair.Refuse("[key, value]");
    instance.config.emplace_back(both[0].Text(), both[1].Text());
  }
  return instance;
}

}  // namespace

nlohmann::json ChangesJson(const std::vector<Change>& changes, const std::vector<Added>& added) {
  nlohmann::json json{{"instances", nlohmann::json::array()}, {"changes", nlohmann::json::array()}};
  for (const auto& [instance, replaces] : added) {
    if (instance.effect.empty()) continue;
    auto config = nlohmann::json::array();
    for (const auto& [key, value] : instance.config) config.push_back({key, value});
    json["instances"].push_back({{"effect", instance.effect},
                                 {"name", instance.name},
                                 {"config", config},
                                 {"replaces", replaces}});
  }
  const char* const operation[] = {"set", "scale", "add"};
  for (const Change& c : changes) {
    json["changes"].push_back({{"target", c.target},
                               {"attribute", c.attribute},
                               {"value", c.value},
                               {"operation", operation[static_cast<int>(c.operation)]}});
  }
  return json;
}

std::string ApplyJson(const ModelSpec& system, const nlohmann::json& json, const std::string& where,
                      const std::filesystem::path& folder) {
  const Json extension = Json(json, where).At("extension");
  std::vector<Change> changes;
  for (const Json& c : extension.At("changes").Items()) changes.push_back(ReadChange(c));
  ModelSpec extended = system;
  try {
    for (const Change& change : changes) RequirePossible(change);
    for (const Json& json_instance : extension.At("instances").Items()) {
      const EffectInstance instance = ReadInstance(json_instance);
      const std::string replaces = json_instance.At("replaces").Text();
      extended = replaces.empty() ? extended.With({}, {{instance}})
                                  : extended.Replacing(replaces, instance);
    }
    return extended.Xml(changes, {}, folder);
  } catch (const Error& error) {
    throw Error::Input(where, error.what());
  }
}

}  // namespace continuum
