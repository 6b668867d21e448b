#pragma once

#include "effects/effect.h"

namespace continuum {

/// A constant force from outside: a spring to the wall, a counterweight, the pull of a hose.
///
///   F = (fx, fy, fz) [N]  in the axes of the world                        (1)
///
/// It acts at the origin of a body or at a site, as a native actuator of constant force (no
/// control) on a site that is measured from one in the world.
struct ExternalForce {
  static constexpr std::string_view kName = "external_force", kSource = "mujoco",
                                    kSummary = "a constant force from outside on a body";
  static constexpr std::array kPlaces{Place::kBody, Place::kSite};
  static constexpr std::array kParams{Signed("fx", "N", 0), Signed("fy", "N", 0),
                                      Signed("fz", "N", 0)};

  template <class Element>
  static void Apply(Element& place, const Vec<double, 3>& p) {
    constexpr std::array<std::string_view, 3> axes{"force[0]", "force[1]", "force[2]"};
    for (std::size_t i = 0; i < 3; ++i) {
      if (p[i] != 0) place.Add(axes[i], p[i]);  // (1)
    }
  }
};

}  // namespace continuum
