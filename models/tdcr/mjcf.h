#pragma once

#include <Eigen/Core>
#include <string>

#include "models/tdcr/robot.h"
#include "sim/model/model_spec.h"

namespace continuum::tdcr {

/// What guides the tendons: the disks alone, straight in between, or a hole in every link, as the
/// channels of the Cosserat rod.
enum class Guides { kDisks, kLinks };

/// Where motors stand for dead loads: a force at the tip alone, or a force and a moment at every
/// disk and at the tip.
enum class Loaded { kTip, kDisks };

/// The robot's MJCF: every arc between disks is cut into links/disks equal pieces of length l.
/// Joints stand in their middles, three hinges each (stiffness EI/l, EI/l, GJ/l, at rest at l u_0
/// about either axis), the pieces themselves are rigid.
///
/// World z is up and the base frame's z down along the straight rod: base x = world x, base y =
/// -world y. Link i reaches from the middle of piece i to that of piece i + 1, so that the end of
/// piece i is inside it; disks sit there, tendons pass through holes there and end at their disks.
/// With kLinks the tendons come along a straight lead, so half of the first bend rubs before the
/// first span: the friction of a channel to second order in l. With kDisks nothing is lost at disk
/// 0. `name` is that of the robot's file. Bodies link<i>, tip (s = L, mass 0); actuators cable<k>
/// [N], tip_fx .. [N, base frame]; sensor tip_pos [m, base frame]. With Loaded::kDisks also
/// disk<i>_fx .. [N] and disk<i>_mx .. [N m] at the sites disk<i>, base frame.
/// @throws Error (input) when links is no multiple of the disks.
std::string RobotMjcf(const Robot& robot, int links, Guides guides,
                      const std::string& name = "tdcr.yaml", Loaded loaded = Loaded::kTip);

/// Tip [m, base frame] after a slow pull of the MJCF from the straight rod: all loads together.
/// Directions come out of the pull; `loads.direction` is not read. @throws Error as Pull, and for
/// loads at disks where the MJCF has no motors for them.
Eigen::Vector3d PulledTip(const ModelSpec& mjcf, const Loads& loads);

}  // namespace continuum::tdcr
