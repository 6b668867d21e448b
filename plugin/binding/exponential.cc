#include "binding/exponential.h"

#include <cmath>
#include <cstddef>

#include "binding/wide.h"

namespace continuum {
namespace {

// The series of e^x: without branches, so that the compiler works on several numbers at once.
template <int kTerms>
inline void Series(const double* x, double* y, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 1;
    for (int i = kTerms; i > 0; --i) sum = 1 + x[k] * (sum * (1.0 / i));
    y[k] = sum;
  }
}

}  // namespace

CONTINUUM_WIDE void Exponential(std::span<const double> x, std::span<double> y) {
  bool small = true, large = false;
  for (const double v : x) small &= v <= 0.06, large |= !(v <= 0.25);
  if (large) {
    for (std::size_t k = 0; k < x.size(); ++k) y[k] = std::exp(x[k]);
  } else if (small) {
    Series<8>(x.data(), y.data(), x.size());
  } else {
    Series<12>(x.data(), y.data(), x.size());
  }
}

}  // namespace continuum
