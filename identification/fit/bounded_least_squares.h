#pragma once

#include <utility>

#include <ceres/ceres.h>

#include "identification/problem/problem.h"

namespace continuum {

/// Parameters in units of their scales, as a solver sees them, and back, within their bounds.
Problem::Vector Scaled(const Problem& problem, const Problem::Vector& x);
Problem::Vector Unscaled(const Problem& problem, const double* y);

/// w with ½ w² = ρ(r), the soft L1 loss of FitOptions (soft 0: w = r), and dw/dr.
std::pair<double, double> SoftL1(double r, double soft);

/// Within which parameters stay.
struct Box {
  Problem::Vector lower, upper;
};
Box BoundsOf(const Problem& problem);
/// In units of their scales.
Box BoxOf(const Problem& problem);

/// The step s within the box that minimises ½ sᵀ A s + gᵀ s, but for bounds that it crosses:
/// unknowns that a bound stops at y do not move, and the others solve without them.
Problem::Vector BoundedStep(const Box& box, const Problem::Vector& y, const Problem::Matrix& A,
                            const Problem::Vector& g);

/// The z in the box that minimises |r + J (z − y)|²; y is in it.
Problem::Vector SolveWithinBox(const Box& box, const Problem::Vector& y, const Problem::Matrix& J,
                               const Problem::Vector& r);

/// When bounded Levenberg-Marquardt ends, and who watches it.
struct Search {
  int iterations;
  double tolerance;  ///< relative decrease of the cost
  ceres::IterationCallback* watch = nullptr;
};

/// Minimises ½ |cost(y)|² within the box, from y and into it.
ceres::Solver::Summary Minimize(ceres::CostFunction& cost, const Box& box, const Search& search,
                                Problem::Vector& y);

}  // namespace continuum
