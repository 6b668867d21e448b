#include "one_mujoco.h"

#include <dlfcn.h>
#include <link.h>

#include <set>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "error.h"

namespace continuum {
namespace {

std::vector<std::string> LoadedFiles() {
  std::vector<std::string> files;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* out) {
        if (info->dlpi_name && *info->dlpi_name)
          static_cast<std::vector<std::string>*>(out)->push_back(info->dlpi_name);
        return 0;
      },
      &files);
  return files;
}

// Files that define MuJoCo's functions, whatever their names.
std::set<std::string> MujocoLibraries() {
  std::set<std::string> found;
  for (const std::string& file : LoadedFiles()) {
    void* const handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (!handle) continue;
    Dl_info where;
    void* const function = dlsym(handle, "mj_version");  // of the file or of what it needs
    if (function && dladdr(function, &where)) found.insert(where.dli_fname);
    dlclose(handle);
  }
  return found;
}

std::string Release(int number) {
  return std::to_string(number / 1'000'000) + "." + std::to_string(number / 1000 % 1000) + "." +
         std::to_string(number % 1000);
}

}  // namespace

void RequireOneMujoco() {
  const auto libraries = MujocoLibraries();
  std::string all;
  for (const auto& path : libraries) all += (all.empty() ? "" : " and ") + path;
  if (libraries.size() > 1) {
    throw Error::Input("mujoco_continuum", "one MuJoCo library in the process", all);
  }
  if (mj_version() != mjVERSION_HEADER) {
    throw Error::Input("mujoco_continuum",
                       "MuJoCo " + Release(mjVERSION_HEADER) + ", for which it was built",
                       Release(mj_version()) + (all.empty() ? "" : " (" + all + ")"));
  }
}

}  // namespace continuum
