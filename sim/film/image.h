#pragma once

#include <filesystem>
#include <vector>

namespace continuum {

/// A picture, 8 bits per channel.
struct Image {
  int width = 0, height = 0;       ///< [px]
  std::vector<unsigned char> rgb;  ///< 3 width height bytes, top row first
};

/// Writes the whole file or nothing. Throws Error when the path cannot be written.
void WritePng(const std::filesystem::path& path, const Image& image);

}  // namespace continuum
