#pragma once

#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Gives a row of the constraint solver another R = 1/D, wherever MuJoCo keeps it.
void SetSoftness(const mjModel& m, mjData& d, int row, double R);

/// Makes pyramidal contacts without friction as soft as condim="1" and elliptic cones have them.
///
/// MuJoCo gives the edges of a pyramid R = 2 mu² R of the normal: the less friction, the harder.
/// Without (mu = 1e-5) a robot at rest sinks in by 1e-13 m, so that rounding loses the contact, and
/// a robot that its cables hold moves by 1e-3 rad in the step that goes without.
/// trees: [ntree] those of the robots.
void SoftenContacts(const mjModel& m, mjData& d, const std::vector<bool>& trees);

}  // namespace continuum
