#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "sim/film/camera_framing.h"
#include "sim/film/gl_context.h"
#include "sim/film/image.h"
#include "sim/film/overlay.h"

namespace continuum {

/// Where a camera looks, as MuJoCo counts it [degree].
struct View {
  double azimuth, elevation;
};

/// The names of a model's cameras, "" for those without.
std::vector<std::string> CamerasOf(const mjModel& m);
/// Which of the cameras has a name. Throws Error that lists the names.
int CameraNamed(const std::vector<std::string>& cameras, std::string_view name);

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
  Renderer(const mjModel& m, int width, int height, Gl gl = Gl::kAuto);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// One of the model's cameras, or the free camera for "". Throws Error that lists the names.
  void SetCamera(std::string_view name);

  /// The free camera, looking this way.
  void SetView(const View& view);

  /// The free camera shall see this pose.
  void Include(const mjModel& m, const mjData& d);
  void Include(const Framing& framing);

  /// One frame. m: the model given at construction or a copy of it; d needs current positions
  /// (mj_kinematics and what follows it). Throws Error for another model or too many geoms.
  Image Draw(const mjModel& m, mjData& d, const Overlay& overlay = {});

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace continuum
