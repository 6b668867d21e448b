#pragma once

#include <optional>
#include <vector>

#include "identification/inverse_dynamics/log_motion.h"
#include "identification/problem/problem.h"

namespace continuum {

/// Equations of motion along the measured motion of all logs, as residuals of the parameters:
///
///   kJoints  F [M a + c − (passive forces and dry friction) − Bᵀ f]    per free joint and row (1)
///   kWrench  F [what a force or torque sensor shows − measured]        per number and row (2)
///
/// f: measured actuator forces, or what the model gives under the logged inputs, with activations
/// of first-order lags (FilteredActivations). F low-passes without phase, after positions, measured
/// wrenches, activations and dry friction have been low-passed once. Residuals of (1) are in units
/// of the RMS force of the actuators on the joint, or where no joint has any of what motion and
/// weight take; those of (2) as Problem::scale has it. The ends of logs, which F has to guess, are
/// left out.
class MeasuredEquations {
 public:
  using Vector = Problem::Vector;
  enum class Part { kJoints, kWrench };

  /// Throws Error for models whose states are not their joints, and as MotionOf does.
  MeasuredEquations(const Problem& problem, const std::vector<bool>& use, double cutoff);

  /// [log] at parameters, equation after equation; empty where a log is not in use (all: use).
  std::vector<Vector> Residuals(const Vector& x, Part part, bool all = false) const;
  /// [equation of a log] of kJoints 0 where dry friction may hold a joint, at the start or with
  /// other parameters; else 1.
  Vector Weight(std::size_t log, Part part) const;
  /// [log] of (1), at the start: the actuators' forces, or those that motion and weight take.
  const std::vector<Vector>& forces() const { return forces_; }
  /// How many of a log's residuals follow each other in time.
  Eigen::Index rows(std::size_t log) const { return rows_[log]; }
  bool has_wrench() const { return wrench_; }
  const std::vector<bool>& use() const { return use_; }

 private:
  struct Forces;
  Forces ForcesOf(const Vector& x, std::size_t log, Part part, std::size_t thread) const;
  Vector Inner(const Problem::Matrix& forces, std::size_t log) const;
  void FindWeights(const std::vector<Forces>& forces);
  void FindInformative(const std::vector<Forces>& forces);

  const Problem& problem_;
  std::vector<bool> use_;
  std::vector<LogMotion> motions_;
  Vector weight_;  ///< [free joint]
  std::vector<Vector> informative_, forces_;
  std::vector<Eigen::Index> rows_;
  bool wrench_ = false;
};

}  // namespace continuum
