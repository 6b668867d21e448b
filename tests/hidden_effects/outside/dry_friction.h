#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace continuum::hidden {

/// How a truth makes dry friction. None of these is the tool's own way:
///   kStick    impulses that stop a joint exactly
///   kTanh     level · tanh(v/v_t) with v_t = 2 mrad/s (2 mm/s on a slide)
///   kBristles a spring that gives 0.2 mrad (0.2 mm) before it slides
///   kNative   MuJoCo's own frictionloss, at a step of 0.1 ms (native.h)
enum class Law { kStick, kTanh, kBristles, kNative };
inline constexpr std::array<std::string_view, 4> kLawNames{"stick", "tanh", "bristles", "native"};

inline constexpr double kTanhSpeed = 2e-3, kGive = 2e-4;

/// Level of a joint's dry friction [N m] or [N] at speed v and load.
///
///   (τ_c (1 + S exp(−(v/v_s)²)) + μ load) (1 ± lean)        + where v > 0
struct DryFriction {
  double tau_c = 0, S = 0, v_s = 0.3;  ///< N m, 1, rad/s
  double mu = 0;                       ///< 1
  double lean = 0;                     ///< 1, share by which the directions differ from the mean

  double Level(double v, double load) const {
    const double slow = v / v_s;
    const double even = tau_c * (1 + S * std::exp(-slow * slow)) + mu * load;
    return std::max(0.0, even * (1 + (v > 0 ? lean : -lean)));
  }
};

}  // namespace continuum::hidden
