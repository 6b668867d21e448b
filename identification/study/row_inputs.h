#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "identification/study/study_row.h"

namespace continuum {

/// Everything that a row's result follows from.
struct RowInputs {
  std::string command, version;
  std::vector<std::string> options;
  std::string model;                         ///< its file, one of `files`
  std::map<std::string, std::string> files;  ///< name from the study's folder, and its SHA-256
  bool operator==(const RowInputs&) const = default;

  /// One hash of all, 64 hexadecimal digits.
  std::string Hash() const;
};

/// SHA-256 of files; each is read once, as rows share models and logs, and anew when its size or
/// the time of its last change are others.
class FileHashes {
 public:
  /// Throws Error for a file that cannot be read.
  const std::string& Of(const std::filesystem::path& file);

 private:
  struct Known {
    std::filesystem::file_time_type changed;
    std::uintmax_t size;
    std::string hash;
  };
  std::map<std::filesystem::path, Known> known_;
};

/// Of a row: its experiment, the model with all that this reads, the logs, and files that options
/// name. Throws Error with the row's place for what is missing.
RowInputs InputsOf(const StudyTable& study, const StudyRow& row, const std::string& version,
                   FileHashes& hashes);

/// What changed, "log_3.csv changed; options: '' became '--seed 2'"; empty: nothing.
std::string ChangesBetween(const RowInputs& before, const RowInputs& now);

}  // namespace continuum
