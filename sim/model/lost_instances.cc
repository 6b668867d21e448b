#include "sim/model/lost_instances.h"

#include <algorithm>

#include <pugixml.hpp>

#include "sim/io/file.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

pugi::xml_document Read(const fs::path& file) {
  pugi::xml_document document;
  const std::string text = ReadFile(file);
  document.load_buffer(text.data(), text.size());
  return document;
}

// Models that a file attaches, and those that these do, each once.
void AddAttached(const fs::path& file, std::vector<fs::path>& all) {
  for (const auto& found : Read(file).select_nodes("//asset/model/@file")) {
    const fs::path attached = (file.parent_path() / found.attribute().value()).lexically_normal();
    std::error_code failed;
    if (!fs::is_regular_file(attached, failed)) continue;
    if (std::find(all.begin(), all.end(), attached) != all.end()) continue;
    all.push_back(attached);
    AddAttached(attached, all);
  }
}

// Attached, a name has a prefix or a suffix.
bool IsThere(const mjModel& m, const std::string& effect, const std::string& instance) {
  for (int i = 0; i < m.nplugin; ++i) {
    const mjpPlugin* const plugin = mjp_getPluginAtSlot(m.plugin[i]);
    const char* const name = mj_id2name(&m, mjOBJ_PLUGIN, i);
    if (plugin && name && plugin->name == effect &&
        std::string(name).find(instance) != std::string::npos)
      return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> LostInstances(const fs::path& model, const mjModel& compiled) {
  std::vector<fs::path> attached;
  AddAttached(model, attached);
  std::vector<std::string> lost;
  for (const fs::path& file : attached) {
    const pugi::xml_document document = Read(file);
    for (const auto& found : document.select_nodes("//extension/plugin/instance")) {
      const std::string effect = found.node().parent().attribute("plugin").value(),
                        instance = found.node().attribute("name").value();
      if (!effect.starts_with("continuum.") || IsThere(compiled, effect, instance)) continue;
      lost.push_back(file.string() + ": " + effect + " '" + instance +
                     "' is lost where the model is attached: MuJoCo keeps instances that a body "
                     "or an actuator refers to (docs/cables.md)");
    }
  }
  return lost;
}

}  // namespace continuum
