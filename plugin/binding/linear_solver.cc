#include "binding/linear_solver.h"

#include <algorithm>
#include <cmath>

#include "binding/wide.h"

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

namespace {

constexpr int kPanel = 4;   // columns that are eliminated together,
constexpr int kLarge = 24;  // as long as there are more than these

// Rows of a matrix of n columns, and what is solved for.
struct Equations {
  double* A;
  double* b;
  int n;
  double* row(int i) const { return A + i * n; }
};

// The largest of column k comes to the diagonal, as its inverse. Rows are exchanged from `begin`
// on.
inline void Pivot(const Equations& e, int k, int begin) {
  int best = k;
  for (int i = k + 1; i < e.n; ++i) {
    if (std::abs(e.row(i)[k]) > std::abs(e.row(best)[k])) best = i;
  }
  if (best != k) {
    std::swap_ranges(e.row(k) + begin, e.row(k) + e.n, e.row(best) + begin);
    std::swap(e.b[k], e.b[best]);
  }
  e.row(k)[k] = 1 / e.row(k)[k];
}

// Eliminates column k from the rows below, up to column `end`: what is left of it are the factors.
inline void EliminateColumn(const Equations& e, int k, int end) {
  const double* const from = e.row(k);
  for (int i = k + 1; i < e.n; ++i) {
    double* const to = e.row(i);
    const double f = to[k] *= from[k];
    if (f == 0) continue;
    Subtract(f, from + k + 1, to + k + 1, end - k - 1);
    e.b[i] -= f * e.b[k];
  }
}

// Row i less the rows of a panel by its factors, one after the other: the same roundings as column
// by column, with a quarter of the loads and stores.
inline void EliminatePanel(const Equations& e, int i, int begin, int end) {
  const double* const f = e.row(i) + begin;
  double* __restrict const z = e.row(i) + end;
  const double* __restrict const w = e.row(begin) + end, * __restrict const x = w + e.n, * __restrict const y = x + e.n, * __restrict const v = y + e.n;
  const double a = f[0], b = f[1], c = f[2], d = f[3];
  for (int j = 0; j < e.n - end; ++j) {
    z[j] = (((z[j] - a * w[j]) - b * x[j]) - c * y[j]) - d * v[j];
  }
}

}  // namespace

CONTINUUM_WIDE void SolveLinear(std::span<double> A, std::span<double> b) {
  const auto n = static_cast<int>(b.size());
  const Equations e{A.data(), b.data(), n};
  int begin = 0;
  for (; n - begin > kLarge; begin += kPanel) {
    const int end = begin + kPanel;
    for (int k = begin; k < end; ++k) Pivot(e, k, begin), EliminateColumn(e, k, end);
    for (int i = begin + 1; i < end; ++i) {
      for (int k = begin; k < i; ++k)
        Subtract(e.row(i)[k], e.row(k) + end, e.row(i) + end, n - end);
    }
    for (int i = end; i < n; ++i) EliminatePanel(e, i, begin, end);
  }
  for (int k = begin; k < n; ++k) Pivot(e, k, k), EliminateColumn(e, k, n);
  for (int k = n - 1; k >= 0; --k) {
    b[k] = (b[k] - Dot(e.row(k) + k + 1, b.data() + k + 1, n - k - 1)) * e.row(k)[k];
  }
}

CONTINUUM_WIDE void BlockSolver::EliminateOne() {
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

CONTINUUM_WIDE void BlockSolver::EliminateTwo() {
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

void BlockSolver::Begin(std::span<const double> K, int n) {
  n_ = n, first_ = 0, matrix_ = K;
  work_.resize(K.size());
  for (int i = 0; i < n; ++i) std::copy_n(K.data() + i * (n + 1), n - i, row(i) + i);
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

CONTINUUM_WIDE void BlockSolver::Solve(std::span<double> b) {
  for (int k = 0; k < first_; ++k) {
    Subtract(b[k], row(k) + k + 1, b.data() + k + 1, n_ - k - 1);
    b[k] *= row(k)[k];
  }
  SolveLinear(block_, b.subspan(first_));
  for (int k = first_; k-- > 0;) b[k] -= Dot(row(k) + k + 1, b.data() + k + 1, n_ - k - 1);
}

}  // namespace continuum
