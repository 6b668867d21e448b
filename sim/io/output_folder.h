#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace continuum {

/// Throws Error where WriteFile would, and where it would write over one of the job's own inputs:
/// to be asked before long work, not after it.
void RequireWritable(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& inputs = {});

/// Throws Error where two outputs of a job, those that are not empty, are one file: the second
/// would take the place of the first.
void RequireDistinct(const std::vector<std::filesystem::path>& outputs);

/// A folder for the outputs of a job, made before it starts. Folders that it made and that are
/// still empty when it ends are taken away again.
class OutputFolder {
 public:
  /// outputs: what the job will write there, folders with a "/" at their end; inputs: what it
  /// reads. Throws Error when the folder cannot be made, or one of the outputs not be written or is
  /// an input.
  OutputFolder(const std::filesystem::path& path, const std::vector<std::string>& outputs,
               const std::vector<std::filesystem::path>& inputs = {});
  OutputFolder(const OutputFolder&) = delete;
  ~OutputFolder();

 private:
  void RemoveEmpty();

  std::vector<std::filesystem::path> made_;  ///< the deepest first
};

}  // namespace continuum
