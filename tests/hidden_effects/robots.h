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

}  // namespace continuum::hidden
