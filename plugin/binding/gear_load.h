#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// The load on the gear of a hinge or slide joint [N*m or N] ≥ 0, at the current actuator_force.
/// option: index into kLoadOptions of effects/load_friction.h.
double GearLoad(const mjModel& m, const mjData& d, int dof, int option);

}  // namespace continuum
