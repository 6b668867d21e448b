#pragma once

#include "effects/effect.h"

namespace continuum {

/// The actuator receives u + offset (after lag and dead time, before its own gain).
struct InputOffset {
  static constexpr std::string_view kName = "input_offset", kSource = "mujoco",
                                    kSummary = "an input with an offset";
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr std::array kParams{Signed("offset", "input", 0)};

  template <class Element>
  static void Apply(Element& actuator, const Vec<double, 1>& p) {
    actuator.Add("input", p[0]);
  }
};

}  // namespace continuum
