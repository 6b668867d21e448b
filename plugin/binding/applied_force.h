#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// force[nv]: everything that MuJoCo applies in this evaluation but constraint forces:
/// passive, actuator, applied and inertial. Valid once actuator_force is known.
void AppliedForces(const mjModel& m, const mjData& d, double* force);

}  // namespace continuum
