#pragma once

#include <Eigen/Core>

#include "sim/model/mujoco_handles.h"

namespace continuum {

/// The damping that a machine lacks to be critically damped in all its small motions around a
/// state. Dry friction, contacts and limits are left out.
class CriticalDamping {
 public:
  /// Measures the machine's own damping at d by differences; Update must follow. The state of d
  /// stays as it was.
  CriticalDamping(mjModel& m, mjData& d);

  /// Measures stiffness and inertia at d, and computes the missing damping anew.
  void Update(mjModel& m, mjData& d);

  /// The force −C v [nv] of (1) in sim/simulation/quasi_static.h, which critical damping lacks.
  Eigen::VectorXd Force(const mjData& d) const;
  /// Time constant of the slowest mode with that damping [s].
  double slowest() const { return slowest_; }

 private:
  Eigen::MatrixXd damping_;   ///< −∂f/∂v
  Eigen::MatrixXd critical_;  ///< C
  double slowest_ = 0;
};

}  // namespace continuum
