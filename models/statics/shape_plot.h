#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace continuum::statics {

/// One case in a picture: points [m] of the backbone in the base frame, joined by a line.
struct Shape {
  std::vector<std::array<double, 3>> line;
  std::vector<std::array<double, 3>> markers = {};   ///< disks, as small dots on the line
  std::vector<std::array<double, 3>> measured = {};  ///< as crosses, without a line
  std::string label = {};
};

struct Picture {
  std::string title;
  /// The two views: components (right, up) of each, 0 = x, 1 = y, 2 = z.
  std::array<std::array<int, 2>, 2> views = {{{0, 2}, {1, 2}}};
  std::vector<Shape> shapes;
};

/// The picture as SVG: two views side by side at one scale, axes in mm, a colour per case.
std::string Svg(const Picture& picture);

/// By extension: .svg or .png, whole or nothing. @throws Error for another extension.
void WritePicture(const std::filesystem::path& path, const Picture& picture);

}  // namespace continuum::statics
