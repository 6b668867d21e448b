#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <mujoco/mujoco.h>

#include "sim/gl.h"
#include "sim/image.h"

namespace continuum {

/// A scale of colours, drawn bottom right: "label" above a bar that goes from `low` to `high`.
struct ColorBar {
  std::string label;      ///< with unit: "cable tension [N]"
  std::string low, high;  ///< texts at the ends: "0", "12.3"
  /// RGB 0..1 at the ends, linear between: as the effects colour their cables.
  std::array<float, 3> from = {0.13f, 0.40f, 0.85f}, to = {0.93f, 0.15f, 0.10f};
};

/// What a frame shows besides the model. Text is ASCII; common signs (degree, micro, times, dashes)
/// are spelled out, others become '?'.
struct Overlay {
  std::string caption = {};                   ///< top left, wrapped to the frame
  std::optional<double> time = {};            ///< [s], bottom left
  std::optional<ColorBar> bar = {};           ///< bottom right
  std::function<void(mjvScene&)> geoms = {};  ///< adds markers to the scene
  mjData* ghost = nullptr;                    ///< a second pose of the model, drawn translucent
};

/// Draws poses of one model off-screen: shadows, no mirroring floor, no multisampling.
///
/// Unless SetCamera chose one of the model's cameras, a free camera frames the robot: everything
/// that can move, and the fixed geoms within its reach (floors and walls are scenery). It sees
/// every pose that Include or Draw was given, whole; it never zooms in again, so that a film whose
/// poses were all included beforehand has a camera at rest. It looks from a three-quarter view, or
/// as the model's visual/global azimuth and elevation say if they are not MuJoCo's defaults.
class Renderer {
 public:
  /// width, height: of the frames [px], at least 64. Throws Error (kInput) for sizes that OpenGL
  /// does not have, and as GlContext does.
  Renderer(const mjModel& m, int width, int height, Gl gl = Gl::kOsmesa);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// One of the model's cameras, or the free camera for "". Throws Error that lists the names.
  void SetCamera(std::string_view name);

  /// The free camera shall see this pose.
  void Include(const mjModel& m, const mjData& d);

  /// One frame. m: the model given at construction or a copy of it; d needs current positions
  /// (mj_kinematics and what follows it). Throws Error for another model or too many geoms.
  Image Draw(const mjModel& m, mjData& d, const Overlay& overlay = {});

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace continuum
