#pragma once

#include <vector>

#include <Eigen/Core>

#include "sim/model/mujoco_handles.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// Forces at states beside that of d, without constraints: neither dry friction of rows, nor
/// contacts and limits. d and the flags of m are given back as they were.
class ForceProbe {
 public:
  /// hooks: of which `step` may write qfrc_applied; none: that of d stays.
  ForceProbe(mjModel& m, mjData& d, const Hooks* hooks = nullptr);
  ForceProbe(const ForceProbe&) = delete;
  ForceProbe& operator=(const ForceProbe&) = delete;
  ~ForceProbe();

  /// At rest, moved along `step` [nv] from where d is; [nv].
  Eigen::VectorXd Moved(const Eigen::VectorXd& step);
  /// At the speed of one degree of freedom, where d is; [nv].
  Eigen::VectorXd Moving(int dof, double speed);

 private:
  void Restore();
  Eigen::VectorXd Force();

  mjModel& m_;
  mjData& d_;
  const Hooks* hooks_;
  int flags_;
  std::vector<double> state_;
};

}  // namespace continuum
