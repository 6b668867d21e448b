#pragma once

#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// The modes of an information matrix H, each parameter in units of what the data say of it alone:
/// D H D has a unit diagonal, D = diag(1/√H_ii) (1 where H_ii is 0). Eigenvalues below 1e-12 are
/// invariances: combinations of parameters that change nothing, as a mass, a stiffness, a damping
/// and a gain that grow together.
class InformationModes {
 public:
  explicit InformationModes(const Problem::Matrix& H);

  /// Smallest eigenvalue; 1 without parameters.
  double smallest() const;
  /// H⁻¹, without the invariances.
  Problem::Matrix Inverse() const;
  /// D V Vᵀ D / 1e-12, V the invariances: a covariance along them that reaches over any bounds.
  Problem::Matrix AlongInvariances() const;
  /// Takes what the J of each log do along the invariances out: J (1 − D V Vᵀ D⁻¹).
  void TakeOutOf(std::vector<Problem::Matrix>& J) const;

 private:
  Problem::Vector unit_;  // D
  Problem::Vector values_;
  Problem::Matrix vectors_;
  Eigen::Index none_ = 0;  // how many are invariances; they come first
};

/// Σ JᵀJ over the logs that have one.
Problem::Matrix InformationIn(const std::vector<Problem::Matrix>& J);

/// Takes out of J what rounding and the curvature of wide differences show along invariances. Where
/// J has a mode that says next to nothing, differences over a millionth of each scale show whether
/// that is nothing: sensitivities of a smooth path are exact, and a machine that sticks from step
/// to step has no such differences. r: residuals at x.
void KeepInvariances(const Problem& problem, const Problem::Vector& x,
                     const std::vector<Problem::Vector>& r, std::vector<Problem::Matrix>& J);

}  // namespace continuum
