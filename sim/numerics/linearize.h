#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/jet.h>
#include <Eigen/Core>

#include "sim/io/interrupt.h"

namespace continuum::numerics {

/// f and J = df/dx by dual numbers or by the problem's own Jacobian; false when x is out of the
/// domain or a number is not finite. f and jacobian must have their sizes. Throws Error when the
/// user has asked to stop: no solver goes on without it.
template <class Problem, class X, class F, class J>
bool Linearize(const Problem& problem, const X& x, F& f, J& jacobian) {
  StopIfRequested();
  if constexpr (requires { problem.Jacobian(x, f, jacobian); }) {
    return problem.Jacobian(x, f, jacobian) && f.allFinite() && jacobian.allFinite();
  } else {
    constexpr bool kFixed = X::RowsAtCompileTime != Eigen::Dynamic;
    // An even number of derivatives fills vector registers: of three, one more costs less than
    // none.
    constexpr int kBlock = kFixed ? X::RowsAtCompileTime + X::RowsAtCompileTime % 2 : 8;
    using Dual = ceres::Jet<double, kBlock>;
    Eigen::Matrix<Dual, X::RowsAtCompileTime, 1> dual_x(x.size());
    Eigen::Matrix<Dual, F::RowsAtCompileTime, 1> dual_f(f.size());
    for (Eigen::Index first = 0; first < x.size(); first += kBlock) {
      const Eigen::Index count = std::min<Eigen::Index>(kBlock, x.size() - first);
      for (Eigen::Index i = 0; i < x.size(); ++i) dual_x[i] = Dual(x[i]);
      for (Eigen::Index i = 0; i < count; ++i) dual_x[first + i].v[i] = 1;
      if (!problem(dual_x.data(), dual_f.data())) return false;
      for (Eigen::Index row = 0; row < f.size(); ++row) {
        jacobian.row(row).segment(first, count) = dual_f[row].v.head(count).transpose();
      }
    }
    for (Eigen::Index row = 0; row < f.size(); ++row) f[row] = dual_f[row].a;
    return f.allFinite() && jacobian.allFinite();
  }
}

/// J by central differences with steps `delta` max(1, |x_i|): for residuals that contain a solve.
template <class Problem, class X, class F, class J>
bool Differences(const Problem& problem, const X& x, double delta, F& f, J& jacobian) {
  if (!problem(x.data(), f.data())) return false;
  X at = x;
  F above = f, below = f;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double h = delta * std::max(1.0, std::abs(x[i]));
    at[i] = x[i] + h;
    if (!problem(at.data(), above.data())) return false;
    at[i] = x[i] - h;
    if (!problem(at.data(), below.data())) return false;
    at[i] = x[i];
    jacobian.col(i) = (above - below) / (2 * h);
  }
  return f.allFinite() && jacobian.allFinite();
}

/// |f(x)|, infinite out of the domain.
template <class Problem, class X, class F>
double NormAt(const Problem& problem, const X& x, F& f) {
  if (!problem(x.data(), f.data()) || !f.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  return f.norm();
}

}  // namespace continuum::numerics
