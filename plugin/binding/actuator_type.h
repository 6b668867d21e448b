#pragma once

#include <array>
#include <string>

namespace continuum {

/// The types of an actuator as MJCF names them, for messages: gaintype="fixed" biastype="none"
/// dyntype="none".
inline std::string ActuatorType(int gain, int bias, int dynamics) {
  constexpr std::array kGain{"fixed", "affine", "muscle", "dcmotor", "so3", "pid", "user"};
  constexpr std::array kBias{"none", "affine", "muscle", "dcmotor", "so3", "user"};
  constexpr std::array kDynamics{"none",   "integrator", "filter", "filterexact",
                                 "muscle", "dcmotor",    "pid",    "user"};
  return "gaintype=\"" + std::string(kGain.at(gain)) + "\" biastype=\"" + kBias.at(bias) +
         "\" dyntype=\"" + kDynamics.at(dynamics) + "\"";
}

}  // namespace continuum
