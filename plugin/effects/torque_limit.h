#pragma once

#include "effects/effect.h"

namespace continuum {

/// An actuator that gives less than its model says: a current limit, a small supply, a hot motor.
///
///   |F| ≤ limit         limit [N*m] of the actuator's force, before its gear     (1)
///
/// A native range of the force, within the one that the model has. On a tendon or a slide joint
/// read N for N*m. limit = inf is the model as it is. Where no torque comes near it nothing depends
/// on it. Source: mujoco.
struct TorqueLimit {
  static constexpr std::string_view kName = "torque_limit", kSource = "mujoco",
                                    kSummary = "an actuator whose force is limited";
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr std::array kParams{
      Param{"limit", "N*m", std::numeric_limits<double>::min(), kInfinity, 0.3, kInfinity}};

  template <class Element>
  static void Apply(Element& actuator, const Vec<double, 1>& p) {
    if (p[0] < kInfinity) actuator.Set("force_limit", p[0]);  // (1)
  }
};

}  // namespace continuum
