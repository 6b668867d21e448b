#pragma once

#include "effects/effect.h"

namespace continuum {

/// A drum, pulley or pinion of another radius than the model's.
///
///   length = gear · scale · x,   force on x = gear · scale · f             (1)
///
/// scale [1] of the gear of an actuator, whose length and force f [N*m] are the motor's · x [rad or
/// m] the joint or the tendon that it pulls. Where the motor winds up a cable or drives a rack,
/// scale is the model's radius over the true one. A motor shows it as an input gain does; a
/// position servo also turns by another angle. No candidate by itself, as it says much of what a
/// gain and a scaled sensor do.
struct DrumRadius {
  static constexpr std::string_view kName = "drum_radius", kSource = "mujoco",
                                    kSummary = "a drum or pulley of another radius";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kActuator};
  static constexpr std::array kParams{Param{"scale", "1", 0, kInfinity, 1, 1}};

  template <class Element>
  static void Apply(Element& actuator, const Vec<double, 1>& p) {
    if (p[0] != 1) actuator.Scale("gear", p[0]);  // (1)
  }
};

}  // namespace continuum
