#pragma once

#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// Equations e + Y (p − x) = 0 of some of a problem's parameters around x, gathered log by log.
class LinearEquations {
 public:
  using Vector = Problem::Vector;
  using Matrix = Problem::Matrix;

  /// columns: those parameters.
  LinearEquations(const Problem& problem, Vector x, std::vector<Eigen::Index> columns);
  /// Y: a column for each of `columns`; weight: 0 or 1 for each equation.
  void Add(const Vector& e, const Matrix& Y, const Vector& weight);

  struct Solution {
    Vector x;     ///< all parameters
    double cost;  ///< what is left of Σ (e + Y (p − x))²
  };
  /// Least squares within the bounds: what leaves them stays at them, the others once more.
  Solution Solve() const;
  /// Whether the equations distinguish all parameters.
  bool AreDistinct() const;
  /// Throws Error for a parameter without effect, and where the equations do not distinguish them.
  void RequireDistinct() const;

 private:
  const Problem& problem_;
  Vector x_;
  std::vector<Eigen::Index> columns_;
  Vector scale_;
  Matrix H_;  ///< in units of scale_
  Vector g_;
  double square_ = 0;
};

}  // namespace continuum
