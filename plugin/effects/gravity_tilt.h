#pragma once

#include <numbers>

#include "effects/effect.h"

namespace continuum {

/// A base that does not stand level: gravity as the robot sees it.
///
///   g' = R_y(pitch) R_x(roll) g            roll, pitch [rad]              (1)
///
/// First roll about x, then pitch about y, both axes fixed in the world of the model.
struct GravityTilt {
  static constexpr std::string_view kName = "gravity_tilt", kSource = "mujoco",
                                    kSummary = "a base that does not stand level";
  static constexpr std::array kPlaces{Place::kWorld};
  static constexpr std::array kParams{
      Param{"roll", "rad", -std::numbers::pi, std::numbers::pi, 0, 0},
      Param{"pitch", "rad", -std::numbers::pi, std::numbers::pi, 0, 0}};

  template <class Element>
  static void Apply(Element& world, const Vec<double, 2>& p) {
    const auto& [roll, pitch] = p;
    if (roll != 0) Turn(world, "gravity[1]", "gravity[2]", roll);    // y toward z
    if (pitch != 0) Turn(world, "gravity[2]", "gravity[0]", pitch);  // z toward x
  }

 private:
  template <class Element>
  static void Turn(Element& world, std::string_view a, std::string_view b, double angle) {
    const double u = world.Get(a), v = world.Get(b);
    world.Set(a, cos(angle) * u - sin(angle) * v);  // (1)
    world.Set(b, sin(angle) * u + cos(angle) * v);
  }
};

}  // namespace continuum
