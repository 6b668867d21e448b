#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// Position [3] and rotation matrix [9, row by row] of a sensor's object in the world.
struct ObjectFrame {
  const double *position, *axes;
};

/// type: mjtObj of a frame sensor; mjOBJ_BODY is the body's inertial frame.
inline ObjectFrame FrameOf(const mjData& d, int type, int id) {
  switch (type) {
    case mjOBJ_BODY:
      return {d.xipos + 3 * id, d.ximat + 9 * id};
    case mjOBJ_GEOM:
      return {d.geom_xpos + 3 * id, d.geom_xmat + 9 * id};
    case mjOBJ_SITE:
      return {d.site_xpos + 3 * id, d.site_xmat + 9 * id};
    case mjOBJ_CAMERA:
      return {d.cam_xpos + 3 * id, d.cam_xmat + 9 * id};
    default:
      return {d.xpos + 3 * id, d.xmat + 9 * id};
  }
}

/// The body that carries a sensor's object.
inline int BodyOf(const mjModel& m, int type, int id) {
  switch (type) {
    case mjOBJ_SITE:
      return m.site_bodyid[id];
    case mjOBJ_GEOM:
      return m.geom_bodyid[id];
    case mjOBJ_CAMERA:
      return m.cam_bodyid[id];
    default:
      return id;
  }
}

}  // namespace continuum
