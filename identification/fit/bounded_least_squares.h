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

/// Within which scaled parameters stay.
struct Box {
  Problem::Vector lower, upper;
};
Box BoxOf(const Problem& problem);

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
