#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>

#include "models/statics/dense_system.h"
#include "models/statics/relax.h"
#include "models/statics/turning.h"
#include "models/tdcr/corrector.h"
#include "models/tdcr/disks.h"
#include "sim/numerics/newton.h"

namespace continuum::tdcr {

/// The segment of arcs between disks. It is a problem for numerics::Newton that keeps the last
/// tangent: one a step away from the root is enough where nothing is near buckling.
template <int C>
class DiskSystem {
 public:
  using Vector = typename DiskBalance<C>::Vector;
  using Matrix = typename DiskBalance<C>::Matrix;

  explicit DiskSystem(DiskBalance<C>& balance) : balance_(balance) {
    last_x_.setConstant(balance.unknowns(), std::numeric_limits<double>::infinity());
    last_.setZero(balance.unknowns(), balance.unknowns());
  }

  bool operator()(const double* x, double* f) const { return balance_(x, f); }
  bool Jacobian(const Vector& x, Vector& f, Matrix& jacobian) const {
    if (!balance_.Jacobian(x, f, jacobian)) return false;
    last_x_ = x;
    last_ = jacobian;
    return true;
  }

  numerics::Outcome Correct(double load, Vector& x) {
    balance_.SetLoad(load);
    return numerics::Newton(*this, x, Corrector(load));
  }

  int Unstable(double load, const Vector& x) {
    balance_.SetLoad(load);
    if (ClearlyStable(x)) return 0;
    Vector f(x.size());
    if (!Jacobian(x, f, last_)) return static_cast<int>(x.size());
    // Its moments act at the starts of arcs, so that the tangent is not quite symmetric.
    if (Eigen::LLT<Matrix>(Symmetric()).info() == Eigen::Success) return 0;
    return statics::NegativeRealParts(balance_.RelativeToUnloaded(last_));
  }

  statics::Fall Fall(double /*from*/, double load, Vector& x) {
    balance_.SetLoad(load);
    statics::DenseSystem<DiskSystem> system(*this);
    Eigen::VectorXd shape = x;
    statics::Fall fall = statics::FallToRest(system, shape);
    x = shape;
    fall.ok = fall.ok && Correct(load, x).ok() && Unstable(load, x) == 0;
    return fall;
  }

  numerics::Outcome Solve(Vector& x) {
    balance_.SetLoad(1);
    return numerics::Newton(*this, x, Limits());
  }

  /// For statics::TurningContacts.
  Eigen::VectorXd Slid(const Vector& x) const { return balance_.SlidAt(x); }
  bool SomeRest(const Vector& x) const { return balance_.SomeRest(x); }
  void GoOnFrom(const Vector& x) { balance_.GoOnFrom(x); }
  Vector Rate(double load, const Vector& x, bool /*exact*/) {
    Vector f(x.size());
    Matrix jacobian(x.size(), x.size());
    const Vector by_load = statics::SlopeByLoad(balance_, load, x);
    if (!balance_.Jacobian(x, f, jacobian)) return Vector::Zero(x.size());
    return Eigen::PartialPivLU<Matrix>(jacobian).solve(-by_load);
  }

  /// For statics::DenseSystem.
  bool Relative(const Eigen::VectorXd& at, Eigen::VectorXd& r, Eigen::MatrixXd* k) const {
    const Vector x = at;
    Vector f(x.size());
    if (k == nullptr) {
      if (!balance_(x.data(), f.data())) return false;
    } else {
      Matrix jacobian(x.size(), x.size());
      if (!balance_.Jacobian(x, f, jacobian)) return false;
      *k = balance_.RelativeToUnloaded(jacobian);
    }
    r = balance_.RelativeToUnloaded(f);
    return r.allFinite();
  }

 private:
  Matrix Symmetric() const {
    const Matrix k = balance_.Stiffness(balance_.RelativeToUnloaded(last_));
    return 0.5 * (k + k.transpose());
  }

  // By the tangent of Newton's last step but one, with a twentieth of the unloaded stiffness to
  // spare; tangents are no further apart when x is within 0.02.
  bool ClearlyStable(const Vector& x) const {
    constexpr double kClose = 0.02, kSpare = 0.05;
    if (last_x_.size() != x.size() || !((last_x_ - x).norm() <= kClose)) return false;
    Matrix spare = Matrix::Identity(x.size(), x.size());
    spare = Symmetric() - kSpare * balance_.Stiffness(spare);
    return Eigen::LLT<Matrix>(spare).info() == Eigen::Success;
  }

  DiskBalance<C>& balance_;
  mutable Vector last_x_;
  mutable Matrix last_;
};

}  // namespace continuum::tdcr
