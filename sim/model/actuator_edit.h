#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// Writes an actuator with <general>, a fixed gain and an affine bias. Throws Error for another
/// kind of gain or bias.
void MakeAffine(mjsActuator& a);

/// First-order lag [s] (filterexact); 0: none. Throws Error for an actuator with other dynamics.
void SetLag(mjsActuator& a, double lag);

/// Dead time of the control [s]. Throws Error when it is negative.
void SetDelay(mjsActuator& a, double delay);

/// Limits the force to ±limit, within the range that the actuator has. Throws Error where nothing
/// is between.
void LimitForce(mjsActuator& a, double limit);

/// Gives a delayed actuator a history that reaches back over its delay at a time step [s], also
/// where rows of a log shorten the steps to an eighth; one that is long enough stays.
void CoverDelay(mjsActuator& a, double timestep);

}  // namespace continuum
