#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/film/film.h"

namespace continuum {

/// One half of a film: an experiment by a model, and what the captions call it.
struct Side {
  const Experiment& experiment;
  const ModelSpec& system;
  std::string name;
  bool labelled = true;  ///< the caption goes on with the label of the log
};

/// The frames of a log by two models, joined: options say the size of a half. Both halves are seen
/// from one place and have one scale. Where one of them ends earlier its last frame stays.
void DrawSideBySide(const Side& left, const Side& right, std::size_t log,
                    const FilmOptions& options, const std::function<void(Image)>& take);

/// FilmExperiment for two models of the same logs, side by side.
void FilmSideBySide(const Side& left, const Side& right, const std::vector<std::size_t>& logs,
                    const std::filesystem::path& file, const FilmOptions& options = {});

}  // namespace continuum
