#pragma once

#include <functional>

#include <mujoco/mujoco.h>

namespace continuum {

/// Stretches a body by a factor along its axis u, a unit vector from its joint a (its origin, where
/// it has none) to the farthest body that it carries, or to its centre of mass:
///
///   x → x + (factor − 1) u uᵀ(x − a)                                       (1)
///
/// for the bodies, sites and geoms (not their sizes) that it carries, and its mass, which stays. A
/// body without an axis stays as it is. compiled: the compiled model of the same specification.
/// before: called with each element it carries, before that changes. Throws Error as SetBodyMass.
void ScaleBodyLength(mjSpec& spec, mjsBody& body, const mjModel& compiled, double factor,
                     const std::function<void(mjsElement*)>& before);

}  // namespace continuum
