#pragma once

#include <string>

#include "models/twin_pivot/twin_pivot.h"
#include "sim/model/model_spec.h"

namespace continuum::twin_pivot {

/// The robot's MJCF, straight along the world's x with Y up.
///
/// A rod of length L that bends in a circular arc turns the next disc as two equal hinges L/6 from
/// its ends do, to the fourth order of the angle: chord 2 (L/6) cos(beta/2) + 2L/3 against
/// L sin(beta/2)/(beta/2). So joint m is bend<m>_in and bend<m>_out, each of twice its stiffness,
/// about z (m odd) or -y. Cables run straight from disc to disc through sites on both faces, where
/// `continuum.capstan` has the mu(theta) of the file. Weights are lumped where the model has
/// them: rods at their middle, a cable's piece by halves at its two holes, locks in the last disc.
/// Body `tip` (O_n, mass 0) takes a payload, actuators tip_fx .. a force in the base frame, sensor
/// tip_pos is in the base frame.
std::string RobotMjcf(const Robot& robot);

/// Tip [m, base frame] after a slow pull of the MJCF from straight: all loads together.
/// @throws Error (input) when the case has a moment or loads on discs, (job) as Pull.
Eigen::Vector3d PulledTip(const ModelSpec& mjcf, const Load& load);

}  // namespace continuum::twin_pivot
