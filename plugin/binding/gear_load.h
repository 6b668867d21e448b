#pragma once

#include <cmath>

#include <mujoco/mujoco.h>

namespace continuum {

/// The load on the gear of a hinge or slide joint [N*m or N] ≥ 0, at the current actuator_force.
/// option: index into kLoadOptions of effects/load_friction.h.
double GearLoad(const mjModel& m, const mjData& d, int dof, int option);

/// What the load is made of: the torque of actuators less that of others (option 0), or alone.
double GearTorque(const mjModel& m, const mjData& d, int dof, int option);
/// The load of a torque.
inline double LoadOf(double torque, int option) {
  return option == 1 ? std::abs(torque) : 0.5 * std::abs(torque);
}

}  // namespace continuum
