#pragma once

#include <vector>

#include "identification/inverse_dynamics/linear_in_bounds.h"
#include "identification/inverse_dynamics/measured_equations.h"

namespace continuum {

/// One part of the equations along the measured motion, over the logs in use, and how it follows
/// parameters.
class TrainEquations {
 public:
  using Vector = Problem::Vector;
  using Matrix = Problem::Matrix;
  using Columns = std::vector<Eigen::Index>;

  TrainEquations(const Problem& problem, const MeasuredEquations& measured,
                 MeasuredEquations::Part part);

  std::vector<Vector> Residuals(const Vector& x) const { return measured_.Residuals(x, part_); }
  /// Residuals of all logs below each other, zero where an equation says nothing.
  Vector Stacked(const Vector& x) const;
  /// Writes slopes by one parameter around x, over a share of its size, to column i; r: residuals.
  void Differ(const Vector& x, const std::vector<Vector>& r, Eigen::Index parameter, double share,
              std::vector<Matrix>& slopes, Eigen::Index i) const;
  /// [log][equation × columns]
  std::vector<Matrix> Slopes(const Vector& x, const std::vector<Vector>& r, const Columns& columns,
                             double share) const;
  LinearEquations Linear(const Vector& x, const std::vector<Vector>& r,
                         const std::vector<Matrix>& slopes, const Columns& columns) const;
  /// Gauss-Newton within the bounds until nothing is gained; throws Error as RequireDistinct does.
  Vector Refined(Vector x, const Columns& columns) const;
  const Vector& weight(std::size_t log) const { return weights_[log]; }

 private:
  const Problem& problem_;
  const MeasuredEquations& measured_;
  MeasuredEquations::Part part_;
  std::vector<Vector> weights_;  ///< [log]
};

}  // namespace continuum
