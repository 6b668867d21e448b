#pragma once

#include <string>
#include <utility>
#include <vector>

#include "effects/effect.h"
#include "identification/problem/problem.h"

namespace continuum {

/// What acts and moves at one joint on the way of all logs, in SI.
struct JointSizes {
  double torque = 0, velocity = 0, count = 0;  ///< squares, and how many of them
  double lower = kInfinity, upper = -kInfinity;
  void Join(const JointSizes& other, double times);
};

/// What a search may assume about sizes, measured on the experiment's own simulation.
struct Sizes {
  double torque = 1;     ///< typical generalized force on the joints [N*m]
  double angle = 1;      ///< typical joint range [rad]
  double velocity = 1;   ///< typical joint speed [rad/s]
  double tension = 1;    ///< typical force along tendons [N]
  double mass = 1;       ///< mean mass of the moving bodies [kg]
  double robot = 1;      ///< mass of all of them [kg]
  double inertia = 1;    ///< inertia that the joints in question see [kg*m^2]
  double length = 1;     ///< typical shift of a part [m]
  double lever = 1;      ///< from the joints to the bodies or sites in question [m]
  double input = 1;      ///< largest control of the actuators in question [their unit]
  double reading = 1;    ///< largest value of the outputs in question [their unit]
  double period = 0.01;  ///< median sampling interval [s]
  double step = 0.002;   ///< of the model [s]
  double duration = 1;   ///< of the longest log [s]
  std::vector<JointSizes> joints = {};
  std::vector<double> outputs = {};  ///< [actuator] its largest force

  /// With torque, angle and velocity of these joints alone, where they move: those of a slide say
  /// nothing of a hinge.
  Sizes OfJoints(const mjModel& m, const std::vector<std::string>& some) const;
  /// With the largest force of these actuators for the torque, where they do anything.
  Sizes OfActuators(const mjModel& m, const std::vector<std::string>& some) const;
};
Sizes SizesOf(const Problem& problem, const Problem::Vector& x);

/// Largest control that the logs give to some actuators [their unit]; 1 where they give none.
double InputSize(const Experiment& experiment, const std::vector<std::string>& actuators);

/// Least and largest value that the logs have of some outputs [their unit]; infinity and its
/// negative where they have none.
std::pair<double, double> ReadingRange(const Experiment& experiment,
                                       const std::vector<std::string>& outputs);

/// Largest of these without sign; 1 where there is none.
double ReadingSize(const Experiment& experiment, const std::vector<std::string>& outputs);

/// The longest lever arm of some bodies or sites about the joints that carry them, in the model's
/// reference pose [m]; 1 where no joint moves them. A slide joint counts as 1.
double LeverOf(const mjModel& m, Place place, const std::vector<std::string>& names);

/// The mass of some bodies together, without those that hang on them [kg]; 1 where they have none.
double MassOf(const mjModel& m, const std::vector<std::string>& bodies);

/// What some joints move in the model's reference pose, on average of their directions [kg*m^2]; 1
/// where there is none. Of a slide joint it is a mass.
double InertiaOf(const mjModel& m, const std::vector<std::string>& joints);

}  // namespace continuum
