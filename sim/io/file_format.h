#pragma once

#include <filesystem>
#include <string_view>

namespace continuum {

/// Whether a file begins as a MATLAB file of version 5 or 7.3 does.
bool IsMat(const std::filesystem::path& file);

/// Throws Error when bytes are of a format that is no text table (Parquet, HDF5, Excel, a ROS bag,
/// JSON, ...): the message names the format and a line that converts the file.
void RequireText(std::string_view bytes, const std::filesystem::path& file);

}  // namespace continuum
