#pragma once

#include <filesystem>
#include <string>

#include <mujoco/mujoco.h>

namespace continuum {

/// The way from a folder to a file, both as they really lie (links followed); absolute when there
/// is no other.
std::filesystem::path RelativePath(const std::filesystem::path& file,
                                   const std::filesystem::path& folder);

/// While it lives, the asset folders of a specification (meshdir, texturedir) lead from `to` to
/// where they led from `from`: MJCF written meanwhile loads from `to`. Folders that are absolute,
/// or that no asset needs, stay as they are.
class AssetFolders {
 public:
  AssetFolders(mjSpec& spec, const std::filesystem::path& from, const std::filesystem::path& to);
  AssetFolders(const AssetFolders&) = delete;
  ~AssetFolders();

 private:
  mjsCompiler& compiler_;
  std::string meshes_, textures_;
};

}  // namespace continuum
