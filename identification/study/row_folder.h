#pragma once

#include <filesystem>
#include <string>

namespace continuum {

/// A folder that becomes another at once: it is filled aside, beside its place, and then renamed.
/// A process that is killed leaves what stood there before, or nothing.
class RowFolder {
 public:
  /// Makes the folder aside, empty. Throws Error when that is impossible.
  RowFolder(const std::filesystem::path& study, const std::string& row);
  RowFolder(const RowFolder&) = delete;
  ~RowFolder();

  const std::filesystem::path& path() const { return path_; }
  /// Puts it in the place of a folder of the study, which goes. Throws Error (kJob) when that is
  /// impossible.
  void Become(const std::string& name);

 private:
  std::filesystem::path study_, path_, old_;
};

/// Takes away what processes of this machine that were killed left aside in a study's folder.
void RemoveLeftBehind(const std::filesystem::path& study);

}  // namespace continuum
