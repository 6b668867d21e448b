#pragma once

#include <string>

#include "models/spa/parameters.h"

namespace continuum {

/// How many actuators, and of how many links each.
struct SpaLayout {
  int links = 10;  ///< N, even
  int series = 1;  ///< actuators on end
  int row = 1;     ///< such arms side by side
};

/// The actuator as MJCF: a chain of N links that share the bend and the stretch evenly.
///
/// Nodes k = 0 .. N lie at the fraction k/N of the length. Link k stretches by δL/N along its
/// parent's z (stretch<k>) and bends at its node by 1/N of the angle, half of that at both ends
/// (bend<k>_x, bend<k>_y, taken in turns first). The nodes of such a chain lie on one circle, at
/// N chords of length (L0 + δL)/N: on the arc itself up to (θ/2N)²/6. The mass is at the nodes with
/// Simpson's weights, m/(3N) (1, 4, 2, .., 4, 1), so that a straight chain has the mass, centre and
/// stretching inertia of a uniform line, and its bending inertia m L²/20 up to 0.7/N⁴. Hinges have
/// the armature (m/N)(L0/N)²/12, which adds 1.7/N⁴ to it; without any, links of point masses could
/// turn freely. Linear joint equalities keep the shares equal.
///
/// The arm hangs: z of `base` points down. One actuator has the names base, link<k>, p1 .. p3,
/// delta, tip_pos, base_force, base_torque; several put seg<i>_ before them, base to tip and arm by
/// arm. Options of the file other than gravity do not matter: mass on the arc, pressure at the tip.
/// Throws Error when the links are not even in number or anything is below one.
std::string SpaMjcf(const SpaFile& file, const SpaLayout& layout = {});

}  // namespace continuum
