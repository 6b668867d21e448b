#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "sim/renderer.h"
#include "sim/simulate.h"

namespace continuum {

struct FilmOptions {
  int width = 960, height = 720, fps = 25;
  std::string camera;  ///< empty: "front" or "side" when the model has it, else framed by itself
  Gl gl = Gl::kOsmesa;
  std::string caption;
  bool ghost = true;  ///< the measured pose, translucent, where joint sensors measure all of it
  std::function<void(const std::string&)> progress = {};
};

/// Simulates the logs and films them one after the other; the simulation is drawn as it is, cables
/// coloured by tension where a capstan effect knows it.
void FilmExperiment(const Experiment& experiment, const System& system,
                    const std::vector<std::size_t>& logs, const std::filesystem::path& file,
                    const FilmOptions& options = {});

/// One frame of the first log at its middle (or of the model at rest), as PNG.
void PictureOf(const Experiment& experiment, const System& system,
               const std::filesystem::path& file, const FilmOptions& options = {});

}  // namespace continuum
