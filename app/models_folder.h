#pragma once

#include <filesystem>

namespace continuum {

/// The folder models/ of the installation that this executable belongs to, or of the sources.
std::filesystem::path ModelsFolder();

}  // namespace continuum
