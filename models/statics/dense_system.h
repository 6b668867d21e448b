#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "sim/numerics/decompositions.h"

namespace continuum::statics {

/// How many eigenvalues have a real part below -1e-9 of the largest: the directions in which an
/// overdamped motion leaves the equilibrium. Of a symmetric matrix, its negative eigenvalues.
int NegativeRealParts(const Eigen::MatrixXd& matrix);

/// A few unknowns x as a system for FallToRest. `Problem` has `bool Relative(x, r, K)`: residual
/// and tangent over the stiffness without loads (then K = 1), false out of the domain.
template <class Problem>
class DenseSystem {
 public:
  using Vector = Eigen::VectorXd;

  explicit DenseSystem(const Problem& problem) : problem_(problem) {}

  bool Linearize(const Vector& x) {
    r_.resize(x.size());
    k_.resize(x.size(), x.size());
    if (!problem_.Relative(x, r_, &k_)) return false;
    least_ = LeastRealEigenvalue(k_);
    return true;
  }
  bool ResidualAt(const Vector& x) { return problem_.Relative(x, r_, nullptr); }
  const Vector& residual() const { return r_; }
  bool Definite(double shift) const { return least_ + shift > -kNeutral; }
  Vector Solve(double shift, const Vector& b) const {
    Eigen::MatrixXd k = k_;
    k.diagonal().array() += shift;
    return Eigen::PartialPivLU<Eigen::MatrixXd>(k).solve(b);
  }
  Vector Unloaded(const Vector& x) const { return x; }
  Vector Moved(const Vector& x, const Vector& step) const { return x + step; }

 private:
  static constexpr double kNeutral = 1e-9;  // a turn about an axis of symmetry costs nothing

  const Problem& problem_;
  Vector r_;
  Eigen::MatrixXd k_;
  double least_ = 0;
};

}  // namespace continuum::statics
