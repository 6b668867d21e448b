#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include <mujoco/mujoco.h>

namespace continuum {

/// A scale of colours, drawn bottom right: "label" above a bar that goes from `low` to `high`.
struct ColorBar {
  std::string label;      ///< with unit: "cable tension [N]"
  std::string low, high;  ///< texts at the ends: "0", "12.3"
  /// RGB 0..1 at the ends, linear between: as the effects colour their cables.
  std::array<float, 3> from = {0.13f, 0.40f, 0.85f}, to = {0.93f, 0.15f, 0.10f};
};

/// A bar of round length [m], about an eighth of the picture. It keeps its length while the model
/// comes a little nearer or goes a little further.
struct Ruler {
  double pixel = 0;   ///< length [m] of one where the model is; 0: not known
  double length = 0;  ///< of the bar [m]

  void Measure(double pixel_length, int width);
};

/// What a frame shows besides the model. Text is ASCII; common signs (degree, micro, times, dashes)
/// are spelled out, others become '?'.
struct Overlay {
  std::string caption = {};                   ///< top left, wrapped to the frame
  std::optional<double> time = {};            ///< [s], bottom left
  Ruler* ruler = nullptr;                     ///< its bar, right of the time
  std::optional<ColorBar> bar = {};           ///< bottom right
  std::function<void(mjvScene&)> geoms = {};  ///< adds markers to the scene
  mjData* ghost = nullptr;                    ///< a second pose of the model, drawn translucent
};

}  // namespace continuum
