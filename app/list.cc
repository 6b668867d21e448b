#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/console.h"
#include "identification/catalog.h"

namespace continuum {
namespace {

nlohmann::json Bound(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

void ListEffects(bool json) {
  auto all = nlohmann::json::array();
  for (const EffectInfo& e : Catalog()) {
    nlohmann::json item{{"name", e.name},
                        {"summary", e.summary},
                        {"source", e.source},
                        {"kind", KindName(e.kind)},
                        {"becomes", Becomes(e.kind)}};
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
    for (const Choice& c : e.choices) item["choices"][std::string(c.name)] = c.options;
    all.push_back(item);
    if (!json) {
      std::printf("%-18s %-10s %-14s %s\n%-44s%s\n", std::string(e.name).c_str(),
                  std::string(KindName(e.kind)).c_str(), places.c_str(),
                  std::string(e.summary).c_str(), "", parameters.c_str());
    }
  }
  if (json) std::printf("%s\n", all.dump(2).c_str());
}

// The folder models/ of the installation that this executable belongs to, or of the sources.
std::filesystem::path ModelsFolder() {
  namespace fs = std::filesystem;
  std::error_code unknown;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", unknown).parent_path().parent_path();
  const fs::path installed = prefix / "share/mujoco_continuum/models";
  return fs::is_directory(installed, unknown) ? installed : fs::path(CONTINUUM_MODELS);
}

// <robot>/<robot>.xml of every robot.
std::vector<std::filesystem::path> Models() {
  std::vector<std::filesystem::path> found;
  if (!std::filesystem::is_directory(ModelsFolder())) return found;
  for (const auto& entry : std::filesystem::directory_iterator(ModelsFolder())) {
    const auto xml = entry.path() / (entry.path().filename().string() + ".xml");
    if (std::filesystem::exists(xml)) found.push_back(xml);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void ListModels(bool json) {
  auto all = nlohmann::json::array();
  for (const auto& model : Models()) {
    all.push_back({{"name", model.stem().string()}, {"file", model.string()}});
    if (!json) std::printf("%-20s %s\n", model.stem().c_str(), model.c_str());
  }
  if (json) std::printf("%s\n", all.dump(2).c_str());
}

}  // namespace

void AddEffects(CLI::App& app) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const sub = app.add_subcommand("effects", "List every effect with its parameters");
  sub->add_flag("--json", *json, "as JSON");
  sub->callback([json] { ListEffects(*json); });
}

void AddModels(CLI::App& app) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const sub = app.add_subcommand("models", "List the robots that come with the project");
  sub->add_flag("--json", *json, "as JSON");
  sub->callback([json] { ListModels(*json); });
}

}  // namespace continuum
