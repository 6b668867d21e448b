#include "identification/inverse_dynamics/parameter_shapes.h"

#include <algorithm>

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;
using Pairs = std::vector<std::vector<bool>>;

constexpr double kReach = 0.2;    // of a parameter's size, in two steps
constexpr double kLinear = 0.01;  // of the smaller first difference

// Which of the parameters bend together, and which alone (the diagonal).
Pairs BendsOf(const Problem& problem, const Vector& x, const std::vector<Eigen::Index>& columns,
              const StackedResiduals& residuals) {
  const std::size_t n = columns.size();
  const Vector here = residuals(x);
  const auto moved = [&](std::size_t j, std::size_t k) -> Vector {
    Vector there = x;
    for (const std::size_t i : {j, k})
      if (i < n) there[columns[i]] += problem.StepOf(x, columns[i], kReach) / 2;
    return residuals(there) - here;
  };
  std::vector<Vector> first;
  for (std::size_t j = 0; j < n; ++j) first.push_back(moved(j, n));
  Pairs bends(n, std::vector<bool>(n, false));
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = j; k < n; ++k) {
      const double size = std::min(first[j].norm(), first[k].norm());
      bends[j][k] = bends[k][j] = (moved(j, k) - first[j] - first[k]).norm() > kLinear * size;
    }
  }
  return bends;
}

// As few as bends of pairs need: the one with most of them, again and again.
std::vector<bool> Outer(const Pairs& bends) {
  const std::size_t n = bends.size();
  std::vector<bool> outer(n);
  for (std::size_t j = 0; j < n; ++j) outer[j] = bends[j][j];
  while (true) {
    std::size_t most = 0, with_most = n;
    for (std::size_t j = 0; j < n; ++j) {
      std::size_t count = 0;
      for (std::size_t k = 0; k < n && !outer[j]; ++k) count += bends[j][k] && !outer[k];
      if (count > most) most = count, with_most = j;
    }
    if (with_most == n) return outer;
    outer[with_most] = true;
  }
}

}  // namespace

ParameterShapes ShapesOf(const Problem& problem, const Vector& x,
                         const std::vector<Eigen::Index>& columns,
                         const StackedResiduals& residuals) {
  const Pairs bends = BendsOf(problem, x, columns, residuals);
  const std::vector<bool> outer = Outer(bends);
  ParameterShapes shapes;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (outer[j]) {
      shapes.outer.push_back(columns[j]);
      continue;
    }
    shapes.inner.push_back(columns[j]);
    bool follows = false;
    for (std::size_t k = 0; k < columns.size(); ++k) follows |= outer[k] && bends[j][k];
    shapes.follows.push_back(follows);
  }
  return shapes;
}

}  // namespace continuum
