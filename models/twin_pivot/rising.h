#pragma once

#include <Eigen/Core>
#include <optional>

#include "models/statics/rising_load.h"
#include "models/twin_pivot/balance.h"
#include "sim/numerics/last_tangent.h"

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

/// s of every contact, row m at disc m; 0 without friction. force: F_mj, as CableForces.
Eigen::MatrixXd SlideAt(const Task& task, const Eigen::VectorXd& beta, std::vector<double>& force);

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

 protected:
  Balance At(double load);

  const Task& from_;
  const Task& to_;
  std::optional<Task> now_;
  double load_ = 1;
  numerics::LastTangentOf<Balance, Eigen::Dynamic> tangent_{0};

 private:
  int driven_ = 0;
};

/// The same with contacts that go on from step to step (statics::TurningContacts).
class RememberingSystem : public RisingSystem {
 public:
  /// `to` gets what the contacts slid from last.
  RememberingSystem(const Task& from, Task& to) : RisingSystem(from, to), going_on_(to) {}

  Eigen::VectorXd Slid(const Eigen::VectorXd& x) const;
  bool SomeRest(const Eigen::VectorXd& x) const;
  Eigen::VectorXd Rate(double load, const Eigen::VectorXd& x, bool exact);
  void GoOnFrom(const Eigen::VectorXd& x);

  /// Parts of the way so far, the last one included.
  int parts() const { return parts_; }

 private:
  Task& going_on_;
  int parts_ = 1;
};

}  // namespace continuum::twin_pivot
