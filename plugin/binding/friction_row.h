#pragma once

#include <vector>

#include "binding/config.h"

namespace continuum {

/// Creates a row without saying how large the friction is: the level is written in every
/// evaluation. MuJoCo's writer of XML takes for 0 what is below 2e-16, so a saved model is as the
/// user wrote it.
inline constexpr double kRowMarker = 1e-300;

/// One row of MuJoCo's constraint solver that holds a dry friction: that of a degree of freedom or
/// of a tendon.
struct FrictionRow {
  bool joint;  ///< else a tendon
  int id;      ///< of the joint or tendon
  int index;   ///< of the degree of freedom or tendon
  int axis;    ///< component of a ball joint, or −1
  bool owner;  ///< the lowest instance on a row assigns level and anchor; others add their level
  bool alone = true;        ///< no other instance of ours is on the row
  double impedance = 0.99;  ///< where the model has MuJoCo's default
};

/// The rows of the joints or tendons that a configuration names, all as owners.
std::vector<FrictionRow> FrictionRowsOf(const mjModel& m, const Config& config, Joints types);

}  // namespace continuum
