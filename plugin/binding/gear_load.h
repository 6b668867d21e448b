#pragma once

#include <cmath>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// Torques on the gears of hinge and slide joints [N*m or N], at the current actuator_force.
/// Gravity compensation that a joint leaves to its actuators (actuatorgravcomp) is theirs. What all
/// of them share is computed once: the cost is linear in joints, actuators and bodies.
class GearTorques {
 public:
  /// Of no model: nobody asks.
  GearTorques() = default;
  /// Where no actuator does anything.
  explicit GearTorques(const mjModel& m) : actuators_(m.nv) {}
  GearTorques(const mjModel& m, const mjData& d);

  /// The torque of actuators less that of others (option 0), or alone. option: index into
  /// kLoadOptions of effects/load_friction.h.
  double At(const mjModel& m, const mjData& d, int dof, int option) const;

 private:
  double Applied(const mjModel& m, const mjData& d, int dof) const;

  std::vector<double> actuators_;  ///< [nv]
  std::vector<int> pushed_;        ///< bodies with a force of the user's
};

/// What gravity on everything beyond a hinge or slide does there [N*m or N], at d's positions.
double WeightTorque(const mjModel& m, const mjData& d, int dof);

/// The load of a torque.
inline double LoadOf(double torque, int option) {
  return option == 1 ? std::abs(torque) : 0.5 * std::abs(torque);
}

}  // namespace continuum
