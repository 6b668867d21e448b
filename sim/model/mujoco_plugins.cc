#include "sim/model/mujoco_plugins.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOurs = "libmujoco_continuum";

fs::path FolderOfMujoco() {
  Dl_info where;
  if (!dladdr(reinterpret_cast<const void*>(&mj_version), &where) || !where.dli_fname) return {};
  return fs::path(where.dli_fname).parent_path();
}

std::vector<fs::path> LibrariesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const fs::path& file = entry.path();
    if (file.extension() == ".so" && !file.filename().string().starts_with(kOurs))
      files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void LoadMujocoPlugins() {
  const fs::path base = FolderOfMujoco();
  if (base.empty()) return;
  for (const fs::path& folder :
       {base / "plugin", base / "mujoco_plugin", base.parent_path() / "bin" / "mujoco_plugin"}) {
    for (const fs::path& file : LibrariesIn(folder)) mj_loadPluginLibrary(file.c_str());
  }
}

}  // namespace continuum
