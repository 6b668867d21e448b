#pragma once

#include <array>
#include <map>
#include <string>

#include "sim/model/model_spec.h"

namespace continuum {

/// Loads that are raised together from zero until a model rests under them. Cables that rub
/// remember how they got there: this is one slow pull from the state without loads.
struct SlowPull {
  std::map<std::string, double> control;  ///< in full, by actuator; the others stay 0
  std::array<double, 3> gravity{};        ///< in full, world frame [m/s^2]
  double rise = 0.6;                      ///< [s]
  double still = 1e-4;                    ///< speed of any joint that counts as rest [rad/s]
  double quiet = 0.1;                     ///< how long it must rest [s]
  double longest = 10;                    ///< after the rise [s]
};

/// Pulls a machine from the state it is in; its data end after a forward pass under all loads.
///
/// The share of the loads is 1 - (1 - t/rise)^3: the pull dies down towards its end, so that no
/// contact that slid is pushed back by the swing of the model.
/// @throws Error (input) for an unknown actuator, (job) when the model diverges or does not come to
/// rest.
void Pull(const ModelAndData& machine, const SlowPull& pull);

/// The three numbers of a sensor.
std::array<double, 3> SensedPoint(const ModelAndData& machine, const std::string& sensor);

}  // namespace continuum
