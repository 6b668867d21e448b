#pragma once

#include <filesystem>
#include <vector>

namespace continuum {

/// What an experiment reads.
struct ExperimentFiles {
  std::filesystem::path model;
  /// Itself first, each once: the model with all that this reads (FilesOfModel), and the logs.
  std::vector<std::filesystem::path> all;
};

/// Rows of logs are not read. Throws Error (file:line and key) for a file that is missing.
ExperimentFiles FilesOfExperiment(const std::filesystem::path& experiment);

}  // namespace continuum
