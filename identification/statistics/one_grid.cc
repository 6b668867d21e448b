#include "identification/statistics/one_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace continuum {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kPoints = 4;  // of an interpolation
constexpr double kRowsLate = 2;

double Variance(const std::vector<double>& y) {
  double sum = 0, squares = 0, n = 0;
  for (const double v : y) {
    if (!std::isnan(v)) sum += v, squares += v * v, n += 1;
  }
  return n > 0 ? squares / n - (sum / n) * (sum / n) : 0;
}

// What the channels differ by, each in units of what it moves.
double Difference(const Log& log, const Log& grid, double shift) {
  double squares = 0, n = 0;
  for (std::size_t c = 0; c < grid.measured.size(); ++c) {
    const double unit = Variance(grid.measured[c]);
    if (!(unit > 0)) continue;
    const OnGrid there = Resampled(log, c, grid, shift);
    for (std::size_t k = 0; k < grid.rows(); ++k) {
      const double d = there.value[k] - grid.measured[c][k];
      if (!std::isnan(d)) squares += d * d / unit, n += 1;
    }
  }
  return n > 0 ? squares / n : 0;
}

}  // namespace

OnGrid Resampled(const Log& log, std::size_t channel, const Log& grid, double shift) {
  const std::vector<double>&t = log.time, &y = log.measured[channel];
  OnGrid out{std::vector<double>(grid.rows(), kNaN), std::vector<double>(grid.rows(), 1)};
  if (log.rows() < kPoints) return out;
  for (std::size_t k = 0; k < grid.rows(); ++k) {
    const double at = grid.time[k] - grid.time[0] + t[0] + shift;
    if (at < t.front() - 1e-9 || at > t.back() + 1e-9) continue;
    const auto next = std::upper_bound(t.begin(), t.end(), at) - t.begin();
    const auto first = std::clamp<std::ptrdiff_t>(next - kPoints / 2, 0, std::ssize(t) - kPoints);
    double value = 0, variance = 0;
    for (auto i = first; i < first + kPoints; ++i) {
      double weight = 1;  // of Lagrange's polynomial
      for (auto j = first; j < first + kPoints; ++j) {
        if (j != i) weight *= (at - t[j]) / (t[i] - t[j]);
      }
      value += weight * y[i], variance += weight * weight;
    }
    out.value[k] = value, out.variance[k] = variance;
  }
  return out;
}

// Coarsely, then finer and finer about the best.
double ShiftOf(const Log& log, const Log& grid) {
  const auto rows = static_cast<double>(log.rows() - 1);
  double best = 0, reach = kRowsLate * (log.time.back() - log.time.front()) / rows;
  for (int round = 0; round < 4; ++round, reach /= 4) {
    const double middle = best;
    double least = Difference(log, grid, middle);
    for (int i = -4; i <= 4; ++i) {
      const double shift = middle + reach * i / 4;
      const double here = Difference(log, grid, shift);
      if (here < least) least = here, best = shift;
    }
  }
  return best;
}

}  // namespace continuum
