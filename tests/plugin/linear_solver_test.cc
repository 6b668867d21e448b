#include "binding/linear_solver.h"

#include <algorithm>
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

// Gaussian elimination as in a book, one column after the other.
Numbers ColumnByColumn(Numbers A, Numbers b) {
  const auto n = static_cast<int>(b.size());
  const auto at = [&](int i, int j) -> double& { return A[i * n + j]; };
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(at(i, k)) > std::abs(at(best, k))) best = i;
    }
    for (int j = k; j < n; ++j) std::swap(at(k, j), at(best, j));
    std::swap(b[k], b[best]);
    const double inverse = 1 / at(k, k);
    for (int i = k + 1; i < n; ++i) {
      const double f = at(i, k) * inverse;
      for (int j = k; j < n; ++j) at(i, j) -= f * at(k, j);
      b[i] -= f * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= at(k, j) * b[j];
    b[k] /= at(k, k);
  }
  return b;
}

TEST(SolveLinear, SeveralColumnsTogetherAreOneAfterTheOther) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const int n : {1, 2, 3, 4, 23, 24, 25, 28, 29, 61}) {
    Numbers A(n * n), b(n);
    for (double& v : A) v = normal(random);
    for (double& v : b) v = normal(random);
    const Numbers due = ColumnByColumn(A, b);
    Numbers x = b, used = A;
    SolveLinear(used, x);
    // Sums of the last part are taken in another order: rounding, by the condition of A.
    double most = 0;
    for (int i = 0; i < n; ++i) most = std::max(most, std::abs(due[i]));
    for (int i = 0; i < n; ++i) EXPECT_NEAR(x[i], due[i], 1e-11 * most) << n;
    // The equations themselves.
    for (int i = 0; i < n; ++i) {
      double left = -b[i];
      for (int j = 0; j < n; ++j) left += A[i * n + j] * x[j];
      EXPECT_NEAR(left, 0, 1e-11 * most) << n;
    }
  }
}

// A zero on the diagonal needs an exchange, in the first column of a panel and in its last.
TEST(SolveLinear, ExchangesRows) {
  for (const int n : {5, 40}) {
    for (const int zero : {0, 3}) {
      Numbers A(n * n, 0), b(n);
      for (int i = 0; i < n; ++i) A[i * n + i] = 2, b[i] = i;
      std::swap_ranges(&A[zero * n], &A[zero * n] + n, &A[(n - 1) * n]);
      std::swap(b[zero], b[n - 1]);
      SolveLinear(A, b);
      for (int i = 0; i < n; ++i) EXPECT_EQ(b[i], i / 2.0);
    }
  }
}

}  // namespace
}  // namespace continuum
