#include "app/models_folder.h"

#include <array>
#include <system_error>

#include "error.h"

namespace continuum {

namespace fs = std::filesystem;

fs::path ModelsFolder() {
  std::error_code unknown;
  const fs::path here = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  const std::array<fs::path, 2> folders{here.parent_path() / "share/mujoco_continuum/models",
                                        (here / CONTINUUM_MODELS).lexically_normal()};
  for (const fs::path& folder : folders) {
    if (fs::is_directory(folder, unknown)) return folder;
  }
  throw Error::Input("the robots", "the folder " + folders[0].string() + ", as installed",
                     "none there; install again, or name the model's own file");
}

}  // namespace continuum
