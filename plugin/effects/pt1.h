#pragma once

#include "effects/effect.h"

namespace continuum {

/// First-order lag of the input.   T ẏ + y = u,  T [s], the native dynamics "filterexact". An
/// actuator has room for one lag: where the model has one already, that one becomes longer by T. A
/// search also makes it shorter.
struct Pt1 {
  static constexpr std::string_view kName = "pt1", kSource = "mujoco",
                                    kSummary = "an input with a first-order lag";
  static constexpr std::string_view kAddsTo = "lag";
  static constexpr Kinship kKin{kLateness};
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr std::array kParams{Param{"T", "s", 0, 10, 0.02, 0}};

  template <class Element>
  static void Apply(Element& actuator, const Vec<double, 1>& p) {
    actuator.Add(kAddsTo, p[0]);
  }
};

}  // namespace continuum
