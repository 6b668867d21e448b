#pragma once

#include <filesystem>
#include <vector>

namespace continuum {

/// All files that an MJCF file reads, itself first, each once: what it includes, meshes, height
/// fields, skins, textures and attached models. A file that is named and does not exist is left to
/// MuJoCo's message. Throws Error when the model cannot be read.
std::vector<std::filesystem::path> FilesOfModel(const std::filesystem::path& model);

}  // namespace continuum
