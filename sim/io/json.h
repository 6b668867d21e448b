#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace continuum {

/// Reads a JSON file. Throws Error (file) when it cannot be read or is no JSON.
nlohmann::json ReadJson(const std::filesystem::path& file);

}  // namespace continuum
