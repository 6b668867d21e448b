#pragma once

#include <span>
#include <vector>

namespace continuum {

/// Solves A x = b by Gaussian elimination with row exchanges. A [n · n] is used up, x replaces b.
void SolveLinear(std::span<double> A, std::span<double> b);

/// Solves (K + U) x = b for several U and b. K [n · n] is symmetric and positive definite; U is
/// zero but for a block of rows and columns from `first` to the last. What stands before the block
/// is eliminated once for all U.
class BlockSolver {
 public:
  /// K [n · n], its upper triangle; it stays where it is.
  void Begin(std::span<const double> K, int n);
  /// What the elimination of the unknowns before `first` leaves of K: add U to it.
  /// [(n − first) · (n − first)]
  std::span<double> Block(int first);
  /// Solves with the last block, which is used up. x replaces b [n].
  void Solve(std::span<double> b);

 private:
  void Eliminate(int first);
  void EliminateOne();
  void EliminateTwo();
  double* row(int i) { return work_.data() + i * n_; }

  int n_ = 0, first_ = 0;
  std::span<const double> matrix_;
  std::vector<double> work_, block_;
};

}  // namespace continuum
