#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/film/film.h"

namespace continuum {

/// A recipe for a film of one model: what its actuators receive from rest, and how it is shown.
///
///     model: ../models/spa/spa.xml
///     camera: side                 # of the model, or {azimuth, elevation} [degree]: frames itself
///     seconds: 4
///     caption: One chamber after the other
///     speed: 0.5                   # optional: half as fast as it is
///     tension: [0, 15]             # optional: of cables, blue and red [N]; else what they reach
///     arrows:                      # optional, length: [m] per N or N m
///       - {sensor: base_force, length: 0.05, color: [0.1, 0.6, 0.3]}
///       - {sensor: base_torque, length: 4, radius: 0.07}             # bent around the torque
///     beside:                      # optional: a second half, where the model has other values
///       caption: Without friction
///       set: {"plugin:friction": {mu: 0}}
///     inputs:                      # actuators that are not named: 0
///       p1: [[0, 0], [1, 0], [1, 4e4]]                           # [s, control], straight between
///       p2: {mean: 2e4, amplitude: 2e4, period: 2, delay: 0.5, rise: 1}
///
/// A wave is min(1, t/rise) (mean + amplitude sin(2 pi (t - delay)/period)), whatever the
/// actuator's range leaves of it.
struct Clip {
  Experiment experiment;  ///< without outputs; its one log are the inputs
  FilmOptions film;

  /// The same model with other values, drawn to the right.
  struct Comparison {
    std::string caption;
    std::vector<Change> set;
    std::string where;  ///< file:line: key, for messages
  };
  std::optional<Comparison> beside = {};

  /// Throws Error with file:line and key.
  static Clip Read(const std::filesystem::path& file);
  /// Whether a file is a recipe, not an experiment.
  static bool Is(const std::filesystem::path& file);
  /// Throws Error when the model lacks the camera, an actuator, a sensor or what `beside` sets.
  void Check(const ModelSpec& system) const;
  /// The model of the right half. Throws Error when it lacks what `beside` sets.
  ModelSpec Beside(const ModelSpec& system) const;
};

}  // namespace continuum
