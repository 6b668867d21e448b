#pragma once

#include <Eigen/Core>

#include "sim/model/mujoco_handles.h"

namespace continuum {

/// Small motions of a machine around a state, without dry friction, contacts and limits.
class CriticalDamping {
 public:
  /// Measures damping at d; Update must follow. d is left as it was, but for what the next step
  /// computes anew.
  CriticalDamping(mjModel& m, mjData& d);

  /// Measures stiffness at d.
  void Update(mjModel& m, mjData& d);

  /// What critical damping of all modes lacks: the force −C v of (1) in
  /// sim/simulation/quasi_static.h.
  Eigen::VectorXd Brake(const mjData& d) const;
  /// Time constant of the slowest mode with that damping [s].
  double slowest() const { return slowest_; }

 private:
  Eigen::MatrixXd damping_;  ///< −∂f/∂v
  Eigen::MatrixXd brake_;    ///< C
  double slowest_ = 0;
};

}  // namespace continuum
