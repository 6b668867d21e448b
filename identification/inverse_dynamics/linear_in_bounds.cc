#include "identification/inverse_dynamics/linear_in_bounds.h"

#include <algorithm>
#include <utility>

#include <Eigen/Dense>

#include "error.h"
#include "sim/numerics/decompositions.h"

namespace continuum {

using Vector = LinearEquations::Vector;
using Matrix = LinearEquations::Matrix;

LinearEquations::LinearEquations(const Problem& problem, Vector x,
                                 std::vector<Eigen::Index> columns)
    : problem_(problem), x_(std::move(x)), columns_(std::move(columns)) {
  const auto n = static_cast<Eigen::Index>(columns_.size());
  scale_.resize(n), H_.setZero(n, n), g_.setZero(n);
  for (Eigen::Index i = 0; i < n; ++i) scale_[i] = problem.parameters()[columns_[i]].scale;
}

void LinearEquations::Add(const Vector& e, const Matrix& Y, const Vector& weight) {
  const Matrix unit = Y * scale_.asDiagonal();
  const Matrix weighted = weight.asDiagonal() * unit;
  H_ += unit.transpose() * weighted;
  g_ += weighted.transpose() * e;
  square_ += e.dot(weight.cwiseProduct(e));
}

void LinearEquations::RequireDistinct() const {
  for (Eigen::Index i = 0; i < H_.rows(); ++i) {
    if (H_(i, i) > 0) continue;
    throw Error::Input("parameter '" + problem_.parameters()[columns_[i]].name + "'",
                       "an effect on the forces of a train log where its joints move", "none");
  }
  if (!AreDistinct()) throw Error::Job("the logs do not distinguish the parameters");
}

bool LinearEquations::AreDistinct() const {
  if (!(H_.diagonal().minCoeff() > 0)) return false;
  const Vector size = H_.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix unit = size.asDiagonal() * H_ * size.asDiagonal();
  return unit.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() >= 1e-10;
}

LinearEquations::Solution LinearEquations::Solve() const {
  const Eigen::Index n = H_.rows();
  std::vector<bool> fixed(n, false);
  Vector change = Vector::Zero(n);
  for (bool again = n > 0; again;) {
    again = false;
    Matrix A = H_;
    Vector b = -g_;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!fixed[i]) continue;
      b -= A.col(i) * change[i];
      A.row(i).setZero(), A.col(i).setZero();
      A(i, i) = 1, b[i] = change[i];
    }
    change = A.ldlt().solve(b);
    for (Eigen::Index i = 0; i < n; ++i) {
      const FreeParameter& p = problem_.parameters()[columns_[i]];
      const double from = x_[columns_[i]], value = from + change[i] * scale_[i];
      if (fixed[i] || (value >= p.lower && value <= p.upper)) continue;
      change[i] = (std::clamp(value, p.lower, p.upper) - from) / scale_[i];
      fixed[i] = again = true;
    }
  }
  Vector x = x_;
  for (Eigen::Index i = 0; i < n; ++i) x[columns_[i]] += scale_[i] * change[i];
  return {problem_.Clamp(x), square_ + change.dot(2 * g_ + H_ * change)};
}

}  // namespace continuum
