#pragma once

#include "effects/effect.h"

namespace continuum {

/// A body that is longer or shorter than the model says: all that is on it moves along its axis u,
/// which leads from its joint a to the farthest body that it carries (to its centre of mass, where
/// it carries none).
///
///   x → x + (scale − 1) u uᵀ(x − a)                                        (1)
///
/// scale [1]. Its mass stays, spread over the new length.
struct LinkLength {
  static constexpr std::string_view kName = "link_length", kSource = "mujoco",
                                    kSummary = "another length of a body, its mass as it is";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kBody};
  static constexpr std::array kParams{Param{"scale", "1", 0, kInfinity, 1, 1}};

  template <class Element>
  static void Apply(Element& body, const Vec<double, 1>& p) {
    if (p[0] != 1) body.Scale("length", p[0]);
  }
};

}  // namespace continuum
