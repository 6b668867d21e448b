#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "sim/film/film.h"

namespace continuum {

/// The options of commands that film the logs of an experiment.
struct Filming {
  std::string size = "960x720", camera, gl = "auto", log;
  int fps = 25;

  /// Adds them to a command.
  std::vector<CLI::Option*> AddTo(CLI::App& command);
  /// What they say of frames. Throws Error for a size, a camera or an OpenGL that there is not.
  void Set(FilmOptions& film, const mjModel& m) const;
  /// The logs to film: all, or the one that was named. Throws Error when there is none of that
  /// name.
  std::vector<std::size_t> LogsOf(const Experiment& e) const;
};

}  // namespace continuum
