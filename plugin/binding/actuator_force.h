#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// What the actuatorfrcrange of a tendon leaves of the forces of its actuators [1].
double TendonShare(const mjModel& m, const mjData& d, int tendon);

/// Force of one output of an actuator, before its gear, as MuJoCo applies it: actuator_force scaled
/// so that the sum over the actuators of a tendon, before their gears, stays in the tendon's
/// actuatorfrcrange; then clamped to the actuator's own forcerange.
double LimitedForce(const mjModel& m, const mjData& d, int actuator, int output = 0);

/// MuJoCo then computes no actuators: passive forces are all that comes.
inline bool IsUnactuated(const mjModel& m) {
  return m.nu == 0 || m.nactuator == 0 || (m.opt.disableflags & mjDSBL_ACTUATION);
}

}  // namespace continuum
