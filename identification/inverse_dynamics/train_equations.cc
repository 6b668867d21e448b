#include "identification/inverse_dynamics/train_equations.h"

#include "sim/io/interrupt.h"

namespace continuum {

using Vector = TrainEquations::Vector;
using Matrix = TrainEquations::Matrix;

TrainEquations::TrainEquations(const Problem& problem, const MeasuredEquations& measured,
                               MeasuredEquations::Part part)
    : problem_(problem), measured_(measured), part_(part) {
  for (std::size_t l = 0; l < measured.use().size(); ++l)
    weights_.push_back(measured.use()[l] ? measured.Weight(l, part) : Vector{});
}

Vector TrainEquations::Stacked(const Vector& x) const {
  const std::vector<Vector> r = Residuals(x);
  Eigen::Index size = 0, at = 0;
  for (const Vector& e : r) size += e.size();
  Vector all(size);
  for (std::size_t l = 0; l < r.size(); ++l) {
    all.segment(at, r[l].size()) = weights_[l].cwiseProduct(r[l]);
    at += r[l].size();
  }
  return all;
}

void TrainEquations::Differ(const Vector& x, const std::vector<Vector>& r, Eigen::Index parameter,
                            double share, std::vector<Matrix>& slopes, Eigen::Index i) const {
  Vector there = x;
  there[parameter] += problem_.StepOf(x, parameter, share);
  const std::vector<Vector> moved = Residuals(there);
  for (std::size_t l = 0; l < r.size(); ++l)
    slopes[l].col(i) = (moved[l] - r[l]) / (there[parameter] - x[parameter]);
}

std::vector<Matrix> TrainEquations::Slopes(const Vector& x, const std::vector<Vector>& r,
                                           const Columns& columns, double share) const {
  std::vector<Matrix> slopes;
  for (const Vector& e : r) slopes.emplace_back(e.size(), std::ssize(columns));
  for (std::size_t i = 0; i < columns.size(); ++i)
    Differ(x, r, columns[i], share, slopes, static_cast<Eigen::Index>(i));
  return slopes;
}

LinearEquations TrainEquations::Linear(const Vector& x, const std::vector<Vector>& r,
                                       const std::vector<Matrix>& slopes,
                                       const Columns& columns) const {
  LinearEquations linear(problem_, x, columns);
  for (std::size_t l = 0; l < r.size(); ++l) linear.Add(r[l], slopes[l], weights_[l]);
  return linear;
}

Vector TrainEquations::Refined(Vector x, const Columns& columns) const {
  constexpr int kSteps = 20, kHalvings = 6;
  constexpr double kSlope = 1e-3, kGain = 1e-8;  // of a parameter's size, of the cost
  double cost = Stacked(x).squaredNorm();
  for (int step = 0; step < kSteps; ++step) {
    StopIfRequested();
    const auto r = Residuals(x);
    const LinearEquations linear = Linear(x, r, Slopes(x, r, columns, kSlope), columns);
    linear.RequireDistinct();
    Vector move = linear.Solve().x - x;
    double lower = Stacked(x + move).squaredNorm();
    for (int i = 0; i < kHalvings && !(lower < cost); ++i)
      move /= 2, lower = Stacked(x + move).squaredNorm();
    if (!(lower < cost)) break;
    const bool last = lower > (1 - kGain) * cost;
    x += move, cost = lower;
    if (last) break;
  }
  return x;
}

}  // namespace continuum
