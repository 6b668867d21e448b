#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/film/measured_points.h"
#include "sim/film/renderer.h"
#include "sim/io/progress.h"
#include "sim/simulation/simulate.h"

namespace continuum {

/// A force or torque sensor as an arrow from its site, seen from the world; with a radius as a bent
/// one around its axis, by the right hand and with its middle on top.
struct Arrow {
  std::string sensor;
  double length;  ///< [m] per N or N m
  std::array<float, 3> color;
  std::string where = {};  ///< file:line: key, for messages
  double radius = 0;       ///< [m]

  /// Throws Error when the model has no such sensor of force or torque.
  int SensorOf(const mjModel& m) const;
};

struct FilmOptions {
  int width = 960, height = 720, fps = 25;
  std::string camera;  ///< empty: "front" or "side" when the model has it, else framed by itself
  std::optional<View> view = {};  ///< a camera that frames the robot by itself, whatever `camera`
  double speed = 1;               ///< seconds of the robot per second of the film
  /// Drawn blue and red [N], of cables with friction and tendons that actuators pull; else over
  /// what the log reaches, in round numbers.
  std::optional<std::array<double, 2>> tension = {};
  std::vector<Arrow> arrows = {};
  bool whole = false;  ///< throw when the simulation diverges; else the film ends there
  Gl gl = Gl::kAuto;
  std::string caption;
  /// The measured pose, translucent, where joint sensors measure all of it; else green balls where
  /// positions are measured.
  bool ghost = true;
  ProgressCallback progress = {};
  InitialState start = {};  ///< of all logs; empty: as the experiment says
};

/// What options add to the scene of a pose: arrows, colours of tendons.
void Decorate(const FilmOptions& options, const mjModel& m, const mjData& d, mjvScene& scene);

/// What was measured as a green ball, with a line to where the simulation has it. What is held is
/// pale and without a line, as the simulation went on.
void DrawMeasured(const MeasuredPoint& point, const mjModel& m, mjvScene& scene);

/// The ranges of positions and tensions in a log, found by simulating it before it is drawn. Camera
/// and colours follow from them.
struct Outlook {
  Framing framing;      ///< of all poses, those that were measured too
  bool marked = false;  ///< whether positions without a pose are measured in some frame
  /// Of cables with friction and tendons that actuators pull [N], from 0, in round numbers; where
  /// options do not say how tension is drawn.
  std::optional<std::array<double, 2>> tension = {};

  void Include(const std::vector<std::optional<double>>& tensions);
  /// What another film of the same scene shows.
  void Include(const Outlook& other);
};
Outlook LookAhead(const Experiment& experiment, const ModelSpec& system, const Log& log,
                  const FilmOptions& options);

/// Simulates a log and draws its frames: the simulation as it is, cables coloured by tension as
/// options.tension or the outlook says, chambers by pressure. ruler: gives the
/// scale, and one scale to all films that share it.
void DrawFrames(const Experiment& experiment, const ModelSpec& system, const Log& log,
                FilmOptions options, const Outlook& ahead, Ruler& ruler,
                const std::function<void(Image)>& take);
/// The same, as a film of its own.
void DrawFrames(const Experiment& experiment, const ModelSpec& system, const Log& log,
                const FilmOptions& options, const std::function<void(Image)>& take);

/// The frames of the logs as a film, one log after the other.
void FilmExperiment(const Experiment& experiment, const ModelSpec& system,
                    const std::vector<std::size_t>& logs, const std::filesystem::path& file,
                    const FilmOptions& options = {});

/// One frame of a log at its middle (or of the model at rest), as PNG.
void PictureOf(const Experiment& experiment, const ModelSpec& system, std::size_t log,
               const std::filesystem::path& file, const FilmOptions& options = {});

}  // namespace continuum
