#pragma once

#include <string>
#include <vector>

#include "hidden_effects/robot.h"

namespace continuum::hidden {

/// What MuJoCo itself is told that the model of the diagnosis has not.
struct NativeTruth {
  std::string model;                  ///< MJCF
  double heavier = 1, longer = 1;     ///< factors on masses and lengths
  std::vector<double> friction = {};  ///< [joint] frictionloss [N m] or [N]
  std::vector<double> start = {};     ///< [joint] position
  std::vector<double> speed = {};     ///< [joint]
};

/// Outputs of all sensors at every row, simulated by MuJoCo at a step of 0.1 ms; u: controls.
Columns RunNative(const NativeTruth& truth, const Columns& u);

}  // namespace continuum::hidden
