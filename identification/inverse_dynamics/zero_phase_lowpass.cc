#include "identification/inverse_dynamics/zero_phase_lowpass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace continuum {
namespace {

// y_k = b (x_k + 2 x_{k−1} + x_{k−2}) − a1 y_{k−1} − a2 y_{k−2}: one pair of poles, by the bilinear
// transform.
struct Biquad {
  double b, a1, a2;

  Biquad(double cutoff, double damping) {
    const double w = std::tan(std::numbers::pi * cutoff), scale = 1 + 2 * damping * w + w * w;
    b = w * w / scale;
    a1 = 2 * (w * w - 1) / scale;
    a2 = (1 - 2 * damping * w + w * w) / scale;
  }
  // From where a signal that has always been y[0] leaves it.
  void Run(std::vector<double>& y) const {
    double x1 = y[0], x2 = y[0], y1 = y[0], y2 = y[0];
    for (double& value : y) {
      const double x = value;
      value = b * (x + 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = x, y2 = y1, y1 = value;
    }
  }
};

}  // namespace

std::vector<double> LowPass(const std::vector<double>& y, double cutoff) {
  const auto n = static_cast<std::ptrdiff_t>(y.size());
  const auto pad = std::min<std::ptrdiff_t>(n - 1, std::lround(3 / cutoff));
  std::vector<double> z;
  for (std::ptrdiff_t k = pad; k > 0; --k) z.push_back(2 * y.front() - y[k]);
  z.insert(z.end(), y.begin(), y.end());
  for (std::ptrdiff_t k = 1; k <= pad; ++k) z.push_back(2 * y.back() - y[n - 1 - k]);
  for (int pass = 0; pass < 2; ++pass) {
    for (const double angle : {1.0, 3.0})
      Biquad(cutoff, std::cos(angle * std::numbers::pi / 8)).Run(z);
    std::reverse(z.begin(), z.end());
  }
  return {z.begin() + pad, z.begin() + pad + n};
}

std::vector<double> Derivative(const std::vector<double>& y, double step) {
  const std::size_t n = y.size();
  std::vector<double> rate(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (k >= 2 && k + 2 < n) {
      rate[k] = (y[k - 2] - 8 * y[k - 1] + 8 * y[k + 1] - y[k + 2]) / (12 * step);
      continue;
    }
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, n - 1);
    rate[k] = (y[after] - y[before]) / (step * static_cast<double>(after - before));
  }
  return rate;
}

}  // namespace continuum
