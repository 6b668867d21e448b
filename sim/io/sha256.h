#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace continuum {

/// SHA-256 of bytes as 64 hexadecimal digits, as `sha256sum` prints it (FIPS 180-4).
std::string Sha256(std::string_view bytes);

/// The same of a file's content. Throws Error when it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& file);

}  // namespace continuum
