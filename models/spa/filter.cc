#include "models/spa/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "error.h"
#include "sim/io/decimal.h"

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

void Check(const std::vector<double>& signal, double cutoff, double period) {
  if (!(cutoff > 0 && cutoff < 0.5 / period)) {
    throw Error::Input("filter", "a cutoff in (0, " + Decimal(0.5 / period) + ") Hz",
                       Decimal(cutoff));
  }
  if (signal.size() < 2) {
    throw Error::Input("filter", "at least 2 samples", std::to_string(signal.size()));
  }
}

// Continued at both ends by point reflection.
std::vector<double> Padded(const std::vector<double>& signal, std::size_t padding) {
  const std::size_t n = signal.size();
  std::vector<double> x;
  x.reserve(n + 2 * padding);
  for (std::size_t i = padding; i > 0; --i) x.push_back(2 * signal[0] - signal[i]);
  x.insert(x.end(), signal.begin(), signal.end());
  for (std::size_t i = 1; i <= padding; ++i) x.push_back(2 * signal[n - 1] - signal[n - 1 - i]);
  return x;
}

}  // namespace

std::vector<double> ZeroPhase(const std::vector<double>& signal, double cutoff, double period) {
  Check(signal, cutoff, period);
  const auto padding =
      std::min(signal.size() - 1, static_cast<std::size_t>(std::ceil(3 / (cutoff * period))));
  std::vector<double> x = Padded(signal, padding);
  const Butterworth filter(cutoff, period);
  for (int pass = 0; pass < 2; ++pass) {
    filter.Run(x);
    std::reverse(x.begin(), x.end());
  }
  return {x.begin() + static_cast<long>(padding), x.end() - static_cast<long>(padding)};
}

std::vector<double> MovingAverage(const std::vector<double>& signal, double cutoff, double period) {
  Check(signal, cutoff, period);
  constexpr double kHalf = 0.6033545644;  // sin(π x)/(π x) = 1/2
  const double around = std::round((kHalf / (cutoff * period) - 1) / 2);
  const auto side = std::min(signal.size() - 1, static_cast<std::size_t>(std::max(around, 0.0)));
  const std::vector<double> x = Padded(signal, side);
  std::vector<double> mean(signal.size());
  for (std::size_t k = 0; k < mean.size(); ++k) {
    double sum = 0;
    for (std::size_t i = 0; i <= 2 * side; ++i) sum += x[k + i];
    mean[k] = sum / double(2 * side + 1);
  }
  return mean;
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
