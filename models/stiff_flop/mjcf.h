#pragma once

#include <string>

#include "models/mjcf/soft_segment.h"
#include "models/stiff_flop/module.h"

namespace continuum::stiff_flop {

/// The module as a segment of constant curvature, small strains. With the section of the law
/// hooke+fixed+fixed at rest (Reaction in elastic.h: n_y = E a (lambda - 1), M = E K zeta):
///
///   k_theta = E K/(l d²), k_dL1 = E a/l, A = n_c pi r_c1², r_ch = r_o, d = r_2             (1)
///
/// volume actuation; damping that makes both motions of the straight module with its mount critical
///
///   d_theta = 2 sqrt(k_theta m_theta), m_theta = (m l²/20 + m_fs ((l + l_fs)/2)²)/d²        (2)
///   d_dL = 2 sqrt(k_dL1 (m/3 + m_fs))                                                       (3)
///
/// (2) by v = s² theta/(2 l) of the centre line and of the mount's centre at l + l_fs/2. What a
/// module carries beside its mount is not counted.
SoftSegment SegmentOf(const Module& module);

/// The module's MJCF: a SoftChain of six links from `base`, whose z runs along the module, with the
/// mount as body `mount` and a site `marker` at its end. Lines act as the native form of (1) in
/// lines.h, F = clamp(gain u - gain dead) with gainprm[0] = gain, biasprm[0] = -gain dead (1 and 0
/// here). The plugin instance `creep` (maxwell) on bend1_* has no stiffness here. Sensors
/// marker_pos and marker_quat in the frame of the site `frame` at the base; delta, tip_pos,
/// base_force, base_torque as of the soft actuator. Chamber i is line i: x of `base` is -x of
/// Robot's frame, its z is y.
///
/// Of modules in series each stands on a body `m2_base` .. at the end of the mount below it, and
/// its names begin with `m1_`, `m2_` ..; `marker` is at the end of the last mount. The step is
/// halved until the plugin's explicit damping is stable. @throws Error for other lines than three
/// at even angles.
///
/// kBraid adds the effect `braid` as the instance `threads` with the file's gamma: pressure then
/// acts on the segment through the law of the braid. kRings leaves it out, gamma = pi/2.
enum class Threads { kRings, kBraid };
std::string ModuleMjcf(const Robot& robot, Threads threads = Threads::kRings);

}  // namespace continuum::stiff_flop
