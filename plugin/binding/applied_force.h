#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// force[nv]: what actuators apply in this evaluation, the gravity compensation that joints leave
/// to them included, before the force ranges of joints. Valid once actuator_force is known.
void ActuatorForces(const mjModel& m, const mjData& d, double* force);

/// force[nv]: everything that MuJoCo applies in this evaluation but constraint forces:
/// passive, actuator, applied and inertial. Valid once actuator_force is known.
void AppliedForces(const mjModel& m, const mjData& d, double* force);

}  // namespace continuum
