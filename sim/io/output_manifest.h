#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace continuum {

/// The files that jobs write into a folder, one job after the other. A file of an earlier job that
/// this one does not write is taken away if it still is as that job left it: its name and a sum of
/// its content stand in the list `.written` of the folder. What was changed since, or never was in
/// the list, stays.
class OutputManifest {
 public:
  /// Makes the folder. Throws Error when that is impossible.
  explicit OutputManifest(const std::filesystem::path& folder);

  /// As WriteFile.
  void Write(const std::string& name, std::string_view content);
  /// Takes away what is left of earlier jobs and writes the list.
  void Finish();

 private:
  using Sums = std::map<std::string, std::uint64_t>;
  Sums ReadList() const;

  std::filesystem::path folder_;
  Sums before_, now_;
};

}  // namespace continuum
