#pragma once

#include "effects/effect.h"

namespace continuum {

/// A point mass at the origin of a body.   m [kg] added, with its effect on centre and inertia.
struct Payload {
  static constexpr std::string_view kName = "payload", kSource = "mujoco",
                                    kSummary = "an additional mass on a body";
  static constexpr Kinship kKin{kInertia};
  static constexpr std::array kPlaces{Place::kBody};
  static constexpr std::array kParams{Magnitude("mass", "kg", 0.01)};

  template <class Element>
  static void Apply(Element& body, const Vec<double, 1>& p) {
    body.Add("point_mass", p[0]);
  }
};

}  // namespace continuum
