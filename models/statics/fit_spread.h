#pragma once

#include <Eigen/Core>
#include <vector>

namespace continuum::statics {

/// A least-squares fit of shapes at its end: residuals f and their slopes J by the free unknowns,
/// shape by shape.
struct FittedShapes {
  Eigen::VectorXd f;
  Eigen::MatrixXd J;
  std::vector<Eigen::Index> begin;  ///< of the rows of every shape, and the end of the last
  Eigen::VectorXd x, low, high;     ///< unknowns and their limits

  std::size_t count() const { return begin.size() - 1; }
};

/// How far the unknowns are known.
struct FitSpread {
  /// sqrt of the diagonal of (J^T J)^-1 |f|^2/(N - p): independent noise and a true model. NaN
  /// where the shapes do not determine it.
  Eigen::VectorXd standard;
  /// Two columns, low and high, 95 %: the fit of as many shapes drawn again with replacement
  /// (1000 times, one Gauss-Newton step within the limits each). What other shapes of the same kind
  /// would give.
  Eigen::MatrixX2d shapes;
  /// The same where the model is wrong: each shape alone asks for x + d_i,
  ///
  ///   d_i = -n (J^T J)^-1 J_i^T f_i,   x ± t_{n-1} rms(d_i)                                  (1)
  ///
  /// A model's error does not average out over shapes that share it, so (1) is not divided by
  /// sqrt(n) as the error of a mean is. No narrower than `shapes`.
  Eigen::MatrixX2d model;
  /// Residuals of every shape by a fit without it, to first order.
  Eigen::VectorXd left_out;
};

/// `free`: which unknowns are not at a limit; the standard error of the others is NaN.
FitSpread SpreadOf(const FittedShapes& fit, const std::vector<bool>& free);

/// The smallest distance that holds the next one of n exchangeable distances with a probability of
/// at least `level` (split conformal: the ceil(level (n + 1))-th of them). Where n is too small for
/// that, their largest, and `level` becomes n/(n + 1).
/// Source: Vovk, Gammerman, Shafer, "Algorithmic Learning in a Random World", 2005.
double WithinOf(std::vector<double> distances, double& level);

}  // namespace continuum::statics
