#include "app/models_folder.h"

#include <system_error>

namespace continuum {

namespace fs = std::filesystem;

fs::path ModelsFolder() {
  std::error_code unknown;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", unknown).parent_path().parent_path();
  const fs::path installed = prefix / "share/mujoco_continuum/models";
  return fs::is_directory(installed, unknown) ? installed : fs::path(CONTINUUM_MODELS);
}

}  // namespace continuum
