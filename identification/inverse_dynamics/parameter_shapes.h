#pragma once

#include <functional>
#include <vector>

#include "identification/problem/problem.h"

namespace continuum {

/// How residuals follow parameters: which enter linearly once the others are known.
struct ParameterShapes {
  /// Chosen by a search: those that residuals follow along a curve, and as few others as take all
  /// products apart (area times offset: one of the two).
  std::vector<Eigen::Index> outer;
  std::vector<Eigen::Index> inner;  ///< all others: residuals are linear in them
  /// [inner] whether its slopes depend on an outer one.
  std::vector<bool> follows;
};

/// Residuals of all equations one below the other; 0 where an equation says nothing.
using StackedResiduals = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// From second differences over a fifth of the parameters' sizes around x, of these parameters:
///
///   bend_jk = r(x + s_j + s_k) − r(x + s_j) − r(x + s_k) + r(x)
///
/// counts where it exceeds a hundredth of the smaller one of the two first differences: dry
/// friction near rest bends forces by less.
ParameterShapes ShapesOf(const Problem& problem, const Eigen::VectorXd& x,
                         const std::vector<Eigen::Index>& columns,
                         const StackedResiduals& residuals);

}  // namespace continuum
