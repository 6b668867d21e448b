#pragma once

#include <Eigen/Core>
#include <optional>

#include "models/statics/rising_load.h"
#include "models/twin_pivot/balance.h"

namespace continuum::twin_pivot {

/// Of Newton's method for all statics of this robot: |f| [N m] and rad.
numerics::Options Tolerances();

/// Negative eigenvalues of the symmetric part of -df/dbeta at full load, where contacts that rest
/// (|s| below 0.98) hold the cable beyond them, and the others slide on; 0 also where that of the
/// contacts as they give way, within eps, is definite. held [N/m]: with which winches hold the
/// cables, where there are any.
int UnstableDirections(Balance balance, const Eigen::VectorXd& beta,
                       const Eigen::VectorXd& held = {});

/// Slopes of the cables' lengths by beta, cables x joints [m].
Eigen::MatrixXd CableSlopes(const Task& task, const Eigen::VectorXd& beta);

/// The robot as a system for statics::FollowRisingLoad: loads grow from those of one task to those
/// of another, contacts as sharp as robot.eps.
class RisingSystem {
 public:
  /// Both must outlive it.
  RisingSystem(const Task& from, const Task& to) : from_(from), to_(to) {}

  numerics::Outcome Correct(double load, Eigen::VectorXd& x);
  int Unstable(double load, const Eigen::VectorXd& x) { return UnstableDirections(At(load), x); }
  statics::Fall Fall(double from, double load, Eigen::VectorXd& x);

  /// Where the last shape that fell came to rest: motions that friction may drive all the same, as
  /// its stiffness is not symmetric.
  int driven() const { return driven_; }

  /// For statics::DenseSystem.
  bool Relative(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* k) const;

 private:
  Balance At(double load);

  const Task& from_;
  const Task& to_;
  std::optional<Task> now_;
  double load_ = 1;
  int driven_ = 0;
};

}  // namespace continuum::twin_pivot
