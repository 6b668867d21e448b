#pragma once

#include <string>

#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// How far a solution goes, for the limits that the robot's file may give.
struct Extent {
  double strain = 0;  ///< of the rods
  double theta = 0;   ///< largest angle of a cable, where mu(theta) acts [rad]; else 0

  Extent() = default;
  Extent(const Robot& robot, const Load& load, const Solution& solution);

  bool BeyondStrain(const Robot& robot) const {
    return robot.strain_limit > 0 && strain > robot.strain_limit;
  }
  bool BeyondTheta(const Robot& robot) const {
    return robot.theta_max > 0 && theta > robot.theta_max;
  }
  /// "strain 0.0162 > 0.015; theta 0.171 > 0.157 rad", empty within both.
  std::string Beyond(const Robot& robot) const;
};

}  // namespace continuum::twin_pivot
