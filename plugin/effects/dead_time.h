#pragma once

#include "effects/effect.h"

namespace continuum {

/// The input arrives late.   y(t) = u(t − delay),  delay [s], a native delay of the actuator, on
/// top of one that it has. A search also makes that one shorter.
struct DeadTime {
  static constexpr std::string_view kName = "dead_time", kSource = "mujoco",
                                    kSummary = "an input that arrives late";
  static constexpr std::string_view kAddsTo = "delay";
  static constexpr Kinship kKin{kLateness};
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr std::array kParams{Param{"delay", "s", 0, 1, 0.01, 0}};

  template <class Element>
  static void Apply(Element& actuator, const Vec<double, 1>& p) {
    actuator.Add(kAddsTo, p[0]);
  }
};

}  // namespace continuum
