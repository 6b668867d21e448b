#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// A force along a joint or a tendon, and how it follows its length, its rate and, of an actuator,
/// the activation [SI].
struct ForceAlong {
  double f = 0, by_length = 0, by_rate = 0, by_activation = 0;
  ForceAlong& operator+=(const ForceAlong& more);
  /// The same where a faster rate is felt.
  ForceAlong Felt(double faster) const;
  ForceAlong Times(double factor) const;
};

/// Spring and damper of a hinge or slide at d, at the speed v.
ForceAlong JointForce(const mjModel& m, const mjData& d, int joint, double v);
/// The same of a tendon.
ForceAlong TendonForce(const mjModel& m, const mjData& d, int tendon, double rate);
/// An actuator with fixed or affine gain and bias, along the joint or tendon that it pulls, of
/// that rate; step: of the lag that acts early [s].
ForceAlong ActuatorForce(const mjModel& m, const mjData& d, int actuator, double rate, double step);
/// The same before its gear and its range, and how it follows its input.
struct ActuatorOutput {
  double f = 0, by_length = 0, by_rate = 0, by_activation = 0, by_input = 0;
};
ActuatorOutput UnlimitedOutput(const mjModel& m, const mjData& d, int actuator, double rate,
                               double step);
/// Length of the joint or tendon that an actuator pulls.
double ActuatedLength(const mjModel& m, const mjData& d, int actuator);
/// Controls as actuators meet them at d's time, behind their delays [nu].
std::vector<double> ControlsMet(const mjModel& m, const mjData& d);
/// The control as an actuator meets it, within its range; d has it behind its delay.
double ControlWithin(const mjModel& m, const mjData& d, int actuator);
/// What an actuator's activation becomes, and how this follows it: its rate (step: 0), or its value
/// after a step [s].
struct Activation {
  double value = 0, by_itself = 0, by_input = 0;
};
/// What a rate of activation is multiplied by in a step [s]: less than the step where the lag is
/// exact.
double ActivationSpan(const mjModel& m, int actuator, double step);
Activation RateOfActivation(const mjModel& m, const mjData& d, int actuator);
Activation NextActivation(const mjModel& m, const mjData& d, int actuator, double step);

/// What has no closed form here ("actuator 'a1' is a muscle"); empty: nothing.
std::string NativeForceObstacle(const mjModel& m);

}  // namespace continuum
