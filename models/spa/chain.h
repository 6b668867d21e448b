#pragma once

#include <limits>
#include <string>

#include "models/spa/parameters.h"

namespace continuum {

/// How many actuators, and of how many links each.
struct SpaLayout {
  int links = 10;                                             ///< N, even
  int series = 1;                                             ///< actuators on end
  int row = 1;                                                ///< such arms side by side
  double evenness = std::numeric_limits<double>::infinity();  ///< SoftChain's s; finite: free
  bool standing = false;                                      ///< else it hangs
};

/// The actuator as MJCF: a SoftChain of N links.
///
/// The arm hangs, z of `base` points down, or stands, z up. One actuator has the names base,
/// link<k>, p1 .. p3, delta, tip_pos, base_force, base_torque; several put seg<i>_ before them,
/// base to tip and arm by arm. Options of the file other than gravity do not matter: mass on the
/// arc, pressure at the tip. Throws Error when the links are not even in number, a number is below
/// one or evenness not > 0.
std::string SpaMjcf(const SpaFile& file, const SpaLayout& layout = {});

}  // namespace continuum
