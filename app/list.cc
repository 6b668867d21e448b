#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/models_folder.h"
#include "binding/effect_catalog.h"

namespace continuum {
namespace {

nlohmann::json Bound(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

void Print(const std::string& text) { std::fputs(text.c_str(), stdout); }

void ListEffects(bool json) {
  auto all = nlohmann::json::array();
  for (const EffectInfo& e : Catalog()) {
    nlohmann::json item{
        {"name", e.name},           {"summary", e.summary},       {"source", e.source},
        {"kind", KindName(e.kind)}, {"becomes", Becomes(e.kind)}, {"only_listed", e.only_listed}};
    std::string places;
    for (const Place p : e.places) {
      item["binds"].push_back(PlaceName(p));
      places += (places.empty() ? "" : ", ") + std::string(PlaceName(p));
    }
    std::string parameters;
    for (const Param& p : e.params) {
      item["parameters"].push_back({{"name", p.name},
                                    {"unit", p.unit},
                                    {"lower", Bound(p.lower)},
                                    {"upper", Bound(p.upper)},
                                    {"initial", p.initial},
                                    {"null", Bound(p.null)},
                                    {"omitted", p.Omitted()}});
      parameters += " " + std::string(p.name) + " [" + std::string(p.unit) + "]";
    }
    for (const Choice& c : e.choices) {
      item["choices"][std::string(c.name)] = c.options;
      parameters += fmt::format(" {} [{}]", c.name, fmt::join(c.options, ", "));
    }
    all.push_back(item);
    if (!json) {
      Print(fmt::format("{:<21} {:<10} {:<14} {}\n{:47}{}\n", e.name, KindName(e.kind), places,
                        std::string(e.summary) + (e.only_listed ? " (only by name)" : ""), "",
                        parameters));
    }
  }
  if (json) Print(all.dump(2) + "\n");
}

// Name and file of every robot: <robot>/<robot>.xml, or all models of a robot with several.
std::map<std::string, std::filesystem::path> Models() {
  std::map<std::string, std::filesystem::path> found;
  if (!std::filesystem::is_directory(ModelsFolder())) return found;
  for (const auto& robot : std::filesystem::directory_iterator(ModelsFolder())) {
    if (!robot.is_directory()) continue;
    const std::string name = robot.path().filename().string();
    if (const auto own = robot.path() / (name + ".xml"); std::filesystem::exists(own)) {
      found[name] = own;
      continue;
    }
    for (const auto& file : std::filesystem::directory_iterator(robot)) {
      if (file.path().extension() == ".xml") found[name + "/" + file.path().stem().string()] = file;
    }
  }
  return found;
}

void ListModels(bool json) {
  auto all = nlohmann::json::array();
  for (const auto& [name, file] : Models()) {
    all.push_back({{"name", name}, {"file", file.string()}});
    if (!json) Print(fmt::format("{:<20} {}\n", name, file.string()));
  }
  if (json) Print(all.dump(2) + "\n");
}

}  // namespace

void AddEffects(CLI::App& app) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const sub = app.add_subcommand("effects", "List every effect with its parameters");
  sub->add_flag("--json", *json, "as JSON");
  sub->footer("Example:\n  continuum effects --json");
  sub->callback([json] { ListEffects(*json); });
}

void AddModels(CLI::App& app) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const sub = app.add_subcommand("models", "List the robots that come with the project");
  sub->add_flag("--json", *json, "as JSON");
  sub->footer("Example:\n  continuum models");
  sub->callback([json] { ListModels(*json); });
}

}  // namespace continuum
