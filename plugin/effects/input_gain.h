#pragma once

#include "effects/effect.h"

namespace continuum {

/// The actuator receives gain · u (after lag and dead time, before its own gain).
struct InputGain {
  static constexpr std::string_view kName = "input_gain", kSource = "mujoco",
                                    kSummary = "an input that acts stronger or weaker";
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr std::array kParams{Param{"gain", "1", -kInfinity, kInfinity, 1, 1}};

  template <class Element>
  static void Apply(Element& actuator, const Vec<double, 1>& p) {
    actuator.Scale("input", p[0]);
  }
};

}  // namespace continuum
