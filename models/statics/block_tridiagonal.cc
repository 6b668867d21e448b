#include "models/statics/block_tridiagonal.h"

#include <Eigen/LU>

namespace continuum::statics {
namespace {

using Eigen::Matrix3d;

// Negative roots of the characteristic polynomial, all real: Descartes' rule of signs is exact.
int Negative(const Matrix3d& s) {
  const double c1 = s.trace();
  const double c2 = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0) + s(0, 0) * s(2, 2) - s(0, 2) * s(2, 0) +
                    s(1, 1) * s(2, 2) - s(1, 2) * s(2, 1);
  const double coefficients[3] = {c1, c2, s.determinant()};
  int changes = 0;
  double sign = 1;
  for (const double c : coefficients) {
    if (c * sign >= 0) continue;
    sign = -sign;
    ++changes;
  }
  return changes;
}

}  // namespace

void BlockTridiagonal::Resize(int blocks) {
  const auto count = static_cast<std::size_t>(blocks);
  diagonal_.assign(count, Matrix3d::Zero());
  lower_.assign(count, Matrix3d::Zero());
  upper_.assign(count, Matrix3d::Zero());
}

void BlockTridiagonal::SetZero() { Resize(blocks()); }

BlockTridiagonal BlockTridiagonal::Plus(double share, const BlockTridiagonal& other) const {
  BlockTridiagonal sum = *this;
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    sum.diagonal_[i] += share * other.diagonal_[i];
    sum.lower_[i] += share * other.lower_[i];
    sum.upper_[i] += share * other.upper_[i];
  }
  return sum;
}

int BlockTridiagonal::NegativeDirections() const {
  int negative = 0;
  Matrix3d inverse;
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    Matrix3d s = 0.5 * (diagonal_[i] + diagonal_[i].transpose());
    if (i > 0) {
      const Matrix3d c = 0.5 * (lower_[i] + upper_[i].transpose());
      s.noalias() -= c * inverse * c.transpose();
    }
    negative += Negative(s);
    inverse = s.inverse();
  }
  return negative;
}

Eigen::Matrix3Xd BlockTridiagonal::Solve(const Eigen::Matrix3Xd& b) const {
  std::vector<Matrix3d> inverse(diagonal_.size());
  Eigen::Matrix3Xd x = b;
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    Matrix3d s = diagonal_[i];
    if (i > 0) {
      const Matrix3d share = lower_[i] * inverse[i - 1];
      s -= share * upper_[i];
      x.col(at) -= share * x.col(at - 1);
    }
    inverse[i] = s.inverse();
  }
  for (auto i = static_cast<Eigen::Index>(diagonal_.size()) - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    Eigen::Vector3d right = x.col(i);
    if (at + 1 < diagonal_.size()) right -= upper_[at + 1] * x.col(i + 1);
    x.col(i) = inverse[at] * right;
  }
  return x;
}

Eigen::Matrix3Xd BlockTridiagonal::Times(const Eigen::Matrix3Xd& x) const {
  Eigen::Matrix3Xd y(3, x.cols());
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    y.col(at) = diagonal_[i] * x.col(at);
    if (i > 0) y.col(at) += lower_[i] * x.col(at - 1);
    if (i + 1 < diagonal_.size()) y.col(at) += upper_[i + 1] * x.col(at + 1);
  }
  return y;
}

Eigen::MatrixXd BlockTridiagonal::Dense() const {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * blocks(), 3 * blocks());
  for (int i = 0; i < blocks(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    dense.block<3, 3>(3 * i, 3 * i) = diagonal_[at];
    if (i == 0) continue;
    dense.block<3, 3>(3 * i, 3 * i - 3) = lower_[at];
    dense.block<3, 3>(3 * i - 3, 3 * i) = upper_[at];
  }
  return dense;
}

}  // namespace continuum::statics
