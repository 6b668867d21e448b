#pragma once

#include "effects/effect.h"

namespace continuum {

/// A body that is heavier or lighter than the model says.   m → scale · m,  I → scale · I,
/// centre of mass unchanged; scale [1].
struct LinkMass {
  static constexpr std::string_view kName = "link_mass", kSource = "mujoco",
                                    kSummary = "another mass of a body, inertia in proportion";
  static constexpr Kinship kKin{kInertia};
  static constexpr std::array kPlaces{Place::kBody};
  static constexpr std::array kParams{Param{"scale", "1", 0, kInfinity, 1, 1}};

  template <class Element>
  static void Apply(Element& body, const Vec<double, 1>& p) {
    if (p[0] != 1) body.Scale("mass", p[0]);
  }
};

}  // namespace continuum
