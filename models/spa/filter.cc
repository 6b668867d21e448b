#include "models/spa/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "error.h"
#include "sim/file.h"

namespace continuum {
namespace {

// Transposed direct form II; starts as if the first value had been there for ever.
struct Butterworth {
  double b0, a1, a2;

  Butterworth(double cutoff, double period) {
    const double w = std::tan(std::numbers::pi * cutoff * period);
    const double norm = 1 / (1 + std::numbers::sqrt2 * w + w * w);
    b0 = w * w * norm;
    a1 = 2 * (w * w - 1) * norm;
    a2 = (1 - std::numbers::sqrt2 * w + w * w) * norm;
  }

  void Run(std::vector<double>& x) const {
    double z1 = (1 - b0) * x[0], z2 = (b0 - a2) * x[0];
    for (double& value : x) {
      const double y = b0 * value + z1;
      z1 = 2 * b0 * value - a1 * y + z2;
      z2 = b0 * value - a2 * y;
      value = y;
    }
  }
};

}  // namespace

std::vector<double> ZeroPhase(const std::vector<double>& signal, double cutoff, double period) {
  if (!(cutoff > 0 && cutoff < 0.5 / period)) {
    throw Error::Input("filter", "a cutoff in (0, " + Decimal(0.5 / period) + ") Hz",
                       Decimal(cutoff));
  }
  const std::size_t n = signal.size();
  if (n < 2) throw Error::Input("filter", "at least 2 samples", std::to_string(n));
  const auto padding = std::min(n - 1, static_cast<std::size_t>(std::ceil(3 / (cutoff * period))));
  std::vector<double> x;
  x.reserve(n + 2 * padding);
  for (std::size_t i = padding; i > 0; --i) x.push_back(2 * signal[0] - signal[i]);
  x.insert(x.end(), signal.begin(), signal.end());
  for (std::size_t i = 1; i <= padding; ++i) x.push_back(2 * signal[n - 1] - signal[n - 1 - i]);

  const Butterworth filter(cutoff, period);
  for (int pass = 0; pass < 2; ++pass) {
    filter.Run(x);
    std::reverse(x.begin(), x.end());
  }
  return {x.begin() + static_cast<long>(padding), x.end() - static_cast<long>(padding)};
}

std::vector<double> Differentiate(const std::vector<double>& signal, double period) {
  const std::size_t n = signal.size();
  if (n < 5) throw Error::Input("derivative", "at least 5 samples", std::to_string(n));
  std::vector<double> rate(n);
  rate[0] = (signal[1] - signal[0]) / period;
  rate[1] = (signal[2] - signal[0]) / (2 * period);
  for (std::size_t i = 2; i + 2 < n; ++i) {
    rate[i] =
        (signal[i - 2] - 8 * signal[i - 1] + 8 * signal[i + 1] - signal[i + 2]) / (12 * period);
  }
  rate[n - 2] = (signal[n - 1] - signal[n - 3]) / (2 * period);
  rate[n - 1] = (signal[n - 1] - signal[n - 2]) / period;
  return rate;
}

}  // namespace continuum
