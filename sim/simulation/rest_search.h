#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/model/mujoco_handles.h"
#include "sim/simulation/trace.h"

namespace continuum {

class ForceProbe;

/// Finds where a machine rests next, without simulating how it gets there.
///
/// From a rest q₀ the inputs have gone a little on. The next rest q is a displacement x from q₀
/// with forces f (all but dry friction) that friction of the levels τ_c holds:
///
///   f_i = τ_i sgn(x_i) where x_i ≠ 0,   |f_i| ≤ τ_i where x_i = 0                 (1)
///
/// This is the least energy, with what friction takes on the way, as long as K = −∂f/∂q is positive
/// definite. Newton's method finds it on the set that slides, with a line search; that is the set
/// with
///
///   |x_i + f_i/K_ii| > τ_i/K_ii                                                  (2)
///
/// K is by differences, learns from each step, and is measured anew where steps do not shrink.
/// Source: hintermueller2002; broyden1965.
class RestSearch {
 public:
  /// hooks: of which `step` may write qfrc_applied.
  RestSearch(mjModel& m, mjData& d, const Hooks& hooks);

  /// Why rests of this machine cannot be found so ("a law that remembers"); empty: they can.
  const std::string& Obstacle() const { return obstacle_; }

  /// Whether dry friction acts, so that a rest depends on the way to it.
  bool Rubs() const { return level_.maxCoeff() > 0; }

  /// Moves d, at rest under other controls, to the next rest under those that it has. False, with d
  /// as it was: no such rest is near, or a contact, a limit or another constraint acts at it.
  bool Advance();

 private:
  bool FindDisplacement(Eigen::VectorXd& x);
  /// That a displacement took so much from the forces.
  void Learn(const Eigen::VectorXd& moved, const Eigen::VectorXd& resisted);
  /// The step to where (1) holds if forces go on as K says, at x with the forces f there.
  Eigen::VectorXd StepAt(const Eigen::VectorXd& x, const Eigen::VectorXd& f) const;
  /// (2): 1 or −1 what slides and which way, 0 what is held.
  Eigen::VectorXd SlidingAt(const Eigen::VectorXd& x, const Eigen::VectorXd& f) const;
  /// Goes along a step until energy and friction work fall no longer: a cable that becomes slack on
  /// the way makes the machine softer than K. Changes x; the forces there.
  Eigen::VectorXd GoAlong(ForceProbe& at, const Eigen::VectorXd& step, Eigen::VectorXd& x,
                          const Eigen::VectorXd& f) const;

  mjModel& m_;
  mjData& d_;
  const Hooks& hooks_;
  std::string obstacle_;
  Eigen::VectorXd level_;      ///< τ_c of each degree of freedom [N*m or N]
  Eigen::MatrixXd stiffness_;  ///< K where it was measured last
};

}  // namespace continuum
