#include "binding/linear.h"

#include <algorithm>
#include <cmath>

namespace continuum {

void SolveLinear(std::vector<double>& A, std::vector<double>& b) {
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
    const double* __restrict const from = row(k);
    for (int i = k + 1; i < n; ++i) {
      double* __restrict const to = row(i);
      const double f = to[k] / from[k];
      for (int j = k + 1; j < n; ++j) to[j] -= f * from[j];
      b[i] -= f * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= row(k)[j] * b[j];
    b[k] /= row(k)[k];
  }
}

}  // namespace continuum
