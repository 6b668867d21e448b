#pragma once

#include "hidden_effects/robot.h"

namespace continuum::hidden {

Robot ArmRobot();  ///< two links with springs and motors, angles and tip
/// A pendulum on a position servo as in models/servo_pendulum, but without dry friction; another
/// gain in every trial.
Robot ServoRobot();
/// A mass on a spring, driven by random-phase multisines, whose position is measured: the two
/// benchmarks of nonlinear system identification with a known cause.
Robot SilverboxRobot();
Robot BoucWenRobot();
Robot SoftActuatorRobot();  ///< one arc of models/spa for a chain of ten links, position of the tip
Robot SnakeArmRobot();      ///< models/annelida in a plane, without dry friction: angles and tip

// The outside suite (outside/cases.h).
Robot PendulumRobot();    ///< one link let go anywhere, its motor switched on and off
Robot ValveRobot();       ///< a piston on a spring, behind a valve of first order
Robot TwoLinkRobot();     ///< two links on position servos with a limit
Robot SnakeRobot();       ///< five links and two cables through sites, pulled by tensions
Robot WinchSnakeRobot();  ///< the same, its cables wound up by position servos
Robot SoftRobot();        ///< one soft arc with three chambers, in a plane

}  // namespace continuum::hidden
