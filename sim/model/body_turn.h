#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// Turns a body with all that it carries by an angle [rad] about an axis of its parent (0, 1, 2: x,
/// y, z) through the body's first joint, or its origin where it has none.
void TurnBody(mjSpec& spec, mjsBody& body, int axis, double angle);

}  // namespace continuum
