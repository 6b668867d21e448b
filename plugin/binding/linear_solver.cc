#include "binding/linear_solver.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

// y −= f x.
inline void Subtract(double f, const double* __restrict x, double* __restrict y, int n) {
  for (int j = 0; j < n; ++j) y[j] -= f * x[j];
}

// z −= f x + g y: half the loads and stores.
inline void Subtract(double f, const double* __restrict x, double g, const double* __restrict y,
                     double* __restrict z, int n) {
  for (int j = 0; j < n; ++j) z[j] -= f * x[j] + g * y[j];
}

// Four sums, for none has to wait for the other.
inline double Dot(const double* x, const double* y, int n) {
  double sum[4] = {0, 0, 0, 0};
  int j = 0;
  for (; j + 4 <= n; j += 4) {
    for (int k = 0; k < 4; ++k) sum[k] += x[j + k] * y[j + k];
  }
  for (; j < n; ++j) sum[0] += x[j] * y[j];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

void SolveLinear(std::span<double> A, std::span<double> b) {
  const auto n = static_cast<int>(b.size());
  const auto row = [&](int i) { return A.data() + i * n; };
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
    }
    if (best != k) {
      std::swap_ranges(row(k) + k, row(k) + n, row(best) + k);
      std::swap(b[k], b[best]);
    }
    double* const from = row(k);
    const double inverse = from[k] = 1 / from[k];
    for (int i = k + 1; i < n; ++i) {
      const double f = row(i)[k] * inverse;
      if (f == 0) continue;
      Subtract(f, from + k + 1, row(i) + k + 1, n - k - 1);
      b[i] -= f * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    b[k] = (b[k] - Dot(row(k) + k + 1, b.data() + k + 1, n - k - 1)) * row(k)[k];
  }
}

void BlockSolver::Begin(std::span<const double> K, int n) {
  n_ = n, first_ = 0, matrix_ = K;
  work_.assign(K.begin(), K.end());
}

std::span<double> BlockSolver::Block(int first) {
  if (first < first_) Begin(matrix_, n_);
  Eliminate(first);
  const int n = n_ - first;
  if (static_cast<int>(block_.size()) < n * n) block_.resize(n * n);
  for (int i = 0; i < n; ++i) {
    std::copy_n(row(first + i) + first + i, n - i, block_.data() + i * n + i);
    for (int j = 0; j < i; ++j) block_[i * n + j] = block_[j * n + i];
  }
  return {block_.data(), static_cast<std::size_t>(n * n)};
}

// K = Uᵀ D U, two rows at a time: U has ones on its diagonal, where work_ keeps 1/D.
void BlockSolver::Eliminate(int first) {
  if ((first - first_) % 2) EliminateOne();
  while (first_ < first) EliminateTwo();
}

void BlockSolver::EliminateOne() {
  const int k = first_++;
  double* const x = row(k);
  const double a = 1 / x[k];
  for (int i = k + 1; i < n_; ++i) {
    const double f = a * x[i];
    if (f != 0) Subtract(f, x + i, row(i) + i, n_ - i);
    x[i] = f;
  }
  x[k] = a;
}

void BlockSolver::EliminateTwo() {
  const int k = first_;
  double *const x = row(k), *const y = row(k + 1);
  const double a = 1 / x[k];
  Subtract(a * x[k + 1], x + k + 1, y + k + 1, n_ - k - 1);
  const double b = 1 / y[k + 1];
  for (int i = k + 2; i < n_; ++i) {
    const double f = a * x[i], g = b * y[i];
    if (f != 0 || g != 0) Subtract(f, x + i, g, y + i, row(i) + i, n_ - i);
    x[i] = f, y[i] = g;
  }
  x[k] = a, x[k + 1] *= a, y[k + 1] = b;
  first_ += 2;
}

void BlockSolver::Solve(std::span<double> b) {
  for (int k = 0; k < first_; ++k) {
    Subtract(b[k], row(k) + k + 1, b.data() + k + 1, n_ - k - 1);
    b[k] *= row(k)[k];
  }
  SolveLinear(block_, b.subspan(first_));
  for (int k = first_; k-- > 0;) b[k] -= Dot(row(k) + k + 1, b.data() + k + 1, n_ - k - 1);
}

}  // namespace continuum
