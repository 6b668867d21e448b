#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace continuum {

/// Numeric columns of a file, by name. Missing values are NaN.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;  ///< one vector per name, all of one length
};

/// A MATLAB file (v5 or v7.3). With a variable: its columns, named "1", "2", …; without: every
/// numeric vector of the file by its name. Throws Error when the file or variable is not usable.
Columns ReadMat(const std::filesystem::path& file, const std::string& variable);

}  // namespace continuum
