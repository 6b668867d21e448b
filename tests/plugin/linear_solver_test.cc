#include "binding/linear_solver.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace continuum {
namespace {

using Numbers = std::vector<double>;

// Symmetric, with the eigenvalues of a chain's inertia spread over six decades.
Numbers Inertia(int n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Numbers K(n * n, 0);
  for (int k = 0; k < n; ++k) {
    Numbers x(n);
    for (double& v : x) v = normal(random);
    const double scale = std::pow(10, -6. * k / n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) K[i * n + j] += scale * x[i] * x[j] + (i == j) * 1e-7;
    }
  }
  return K;
}

TEST(BlockSolver, SolvesWithEveryBlockInAnyOrder) {
  constexpr int n = 13;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Numbers K = Inertia(n, random);
  BlockSolver solver;
  solver.Begin(K, n);
  for (const int first : {13, 5, 6, 9, 0, 12, 3, 13, 13, 1}) {
    const std::span<double> block = solver.Block(first);
    const int m = n - first;
    ASSERT_EQ(block.size(), static_cast<std::size_t>(m * m));
    Numbers A = K, b(n);
    for (double& v : b) v = normal(random);
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < m; ++j) {
        const double u = normal(random);
        block[i * m + j] += u, A[(first + i) * n + first + j] += u;
      }
    }
    Numbers x = b;
    solver.Solve(x);
    double size = 0;
    for (const double v : x) size = std::max(size, std::abs(v));
    for (int i = 0; i < n; ++i) {
      double residual = -b[i];
      for (int j = 0; j < n; ++j) residual += A[i * n + j] * x[j];
      // Elimination is backward stable: about 500 roundings of n products, entries of A up to 20.
      EXPECT_NEAR(residual, 0, 1e-13 * n * (1 + size * 20)) << first << " " << i;
    }
  }
}

TEST(BlockSolver, TreesThatDoNotTouchStayApart) {
  const Numbers K{2, 0, 1, 0, 0, 3, 0, 1, 0, 0, 2, 0, 0, 0, 0, 3};  // upper triangle
  BlockSolver solver;
  solver.Begin(K, 4);
  solver.Block(4);
  Numbers x{3, 4, 3, 4};
  solver.Solve(x);
  for (const double v : x) EXPECT_NEAR(v, 1, 1e-15);
}

}  // namespace
}  // namespace continuum
