#pragma once

#include <Eigen/Core>
#include <vector>

namespace continuum::statics {

/// A square matrix of 3 x 3 blocks on the diagonal and beside it: the stiffness of a chain whose
/// neighbours alone act on each other. All work grows with the number of blocks, not its cube.
class BlockTridiagonal {
 public:
  explicit BlockTridiagonal(int blocks) { Resize(blocks); }

  void Resize(int blocks);
  void SetZero();
  int blocks() const { return static_cast<int>(diagonal_.size()); }

  Eigen::Matrix3d& diagonal(int i) { return diagonal_[static_cast<std::size_t>(i)]; }
  /// Row i, column i - 1 and row i - 1, column i; i >= 1.
  Eigen::Matrix3d& lower(int i) { return lower_[static_cast<std::size_t>(i)]; }
  Eigen::Matrix3d& upper(int i) { return upper_[static_cast<std::size_t>(i)]; }

  /// this + share other; both of one size.
  BlockTridiagonal Plus(double share, const BlockTridiagonal& other) const;

  /// How many eigenvalues of the symmetric part are negative, by Sylvester's law of inertia:
  /// S_0 = D_0, S_i = D_i - C_i S_{i-1}^-1 C_i^T have as many together.
  int NegativeDirections() const;

  /// x with (this) x = b, both 3 x blocks; not finite when a block on the way is singular.
  Eigen::Matrix3Xd Solve(const Eigen::Matrix3Xd& b) const;
  Eigen::Matrix3Xd Times(const Eigen::Matrix3Xd& x) const;
  Eigen::MatrixXd Dense() const;

 private:
  std::vector<Eigen::Matrix3d> diagonal_, lower_, upper_;
};

}  // namespace continuum::statics
