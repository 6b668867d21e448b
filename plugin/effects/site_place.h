#pragma once

#include "effects/effect.h"

namespace continuum {

/// A site that is elsewhere on its body: a marker, the hole of a cable, a tool.
///
///   p → p + (dx, dy, dz)         [m] in the axes of its body              (1)
///
/// Cables through the site and sensors on it move with it. No candidate by itself: three numbers of
/// a measured site take up most of what other lengths and angles do. Along a straight cable nothing
/// depends on it.
struct SitePlace {
  static constexpr std::string_view kName = "site_place", kSource = "mujoco",
                                    kSummary = "a site that is elsewhere on its body";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kSite};
  static constexpr std::array kParams{Signed("dx", "m", 1e-3), Signed("dy", "m", 1e-3),
                                      Signed("dz", "m", 1e-3)};

  template <class Element>
  static void Apply(Element& site, const Vec<double, 3>& p) {
    constexpr std::string_view kPlace[]{"pos[0]", "pos[1]", "pos[2]"};
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (p[i] != 0) site.Add(kPlace[i], p[i]);  // (1)
    }
  }
};

}  // namespace continuum
