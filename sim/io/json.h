#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace continuum {

/// A file of ours read back. Throws Error when it cannot be read or is no JSON.
nlohmann::json ReadJson(const std::filesystem::path& file);

}  // namespace continuum
