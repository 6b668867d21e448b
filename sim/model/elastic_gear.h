#pragma once

#include <functional>
#include <string>

#include <mujoco/mujoco.h>

namespace continuum {

/// The joint, its body, and the tendon of an elastic gear have one name: ".gear_" and that of the
/// joint that the motor turns. Globs leave it out (GlobMatches).
std::string GearName(const std::string& joint);

/// Puts a spring [rad/(N*m) or m/N] between a joint and what drives it: its armature becomes a
/// joint of its own, which its actuators pull (effects/elastic_gear.h). A gear that is there gets
/// another compliance. A spring that is stiffer than steps of the model can show leaves the joint
/// as it is.
///
/// before: called with each other element before it changes; made: with each that is made; undo:
/// takes what puts back the rest. compiled: the compiled model of the same specification. Throws
/// Error for a joint that is neither hinge nor slide, has no name, no armature or no actuator.
struct GearEdits {
  std::function<void(mjsElement*)> before, made;
  std::function<void(std::function<void()>)> undo;
};
void SetGearCompliance(mjSpec& spec, mjsJoint& joint, const mjModel& compiled, double compliance,
                       const GearEdits& edits);

/// The tendon and the joint of the motor of an elastic gear; null: it has none.
mjsTendon* GearOf(mjSpec& spec, const mjsJoint& joint);
mjsJoint* GearMotorOf(mjSpec& spec, const mjsJoint& joint);

/// The joint of the motor that turns a joint by an elastic gear; -1: none.
int GearMotorOf(const mjModel& m, int joint);
/// How many joints are such motors, and whether one is (-1: no joint, false).
int GearMotors(const mjModel& m);
bool IsGearMotor(const mjModel& m, int joint);

/// Moves every motor to where its spring is at rest [nq], [nv].
void FollowGears(const mjModel& m, double* qpos, double* qvel);
/// Puts a hinge or slide elsewhere; the motor of its gear moves with it.
void PlaceJoint(const mjModel& m, mjData& d, int joint, double q, double v);

}  // namespace continuum
