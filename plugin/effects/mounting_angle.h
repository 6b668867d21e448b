#pragma once

#include "effects/effect.h"

namespace continuum {

/// A link that is mounted at an angle: the body and all that it carries, its joints' axes too, are
/// turned about its first joint a (about its origin, where it has none).
///
///   x → a + R (x − a),   R = R_z(yaw) R_y(pitch) R_x(roll)                 (1)
///
/// roll, pitch, yaw [rad] about the axes of the parent, first roll. No candidate by itself: with a
/// few outputs three angles of a link also say what lengths and zeros of joints do.
struct MountingAngle {
  static constexpr std::string_view kName = "mounting_angle", kSource = "mujoco",
                                    kSummary = "a link that is mounted at an angle";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kBody};
  static constexpr std::array kParams{Param{"roll", "rad", -3, 3, 0.02, 0},
                                      Param{"pitch", "rad", -3, 3, 0.02, 0},
                                      Param{"yaw", "rad", -3, 3, 0.02, 0}};

  template <class Element>
  static void Apply(Element& body, const Vec<double, 3>& p) {
    constexpr std::string_view kTurns[]{"turn[0]", "turn[1]", "turn[2]"};
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (p[i] != 0) body.Add(kTurns[i], p[i]);  // (1)
    }
  }
};

}  // namespace continuum
