#include "sim/page/axis_scale.h"

#include <algorithm>
#include <cmath>

#include "sim/page/text.h"

namespace continuum::page {
namespace {

double RoundStep(double step) {
  const double decade = std::pow(10, std::floor(std::log10(step)));
  const double mantissa = step / decade;
  return decade * (mantissa <= 1.5 ? 1 : mantissa <= 3.5 ? 2 : mantissa <= 7.5 ? 5 : 10);
}

}  // namespace

std::vector<Tick> Ticks(double low, double high, int count) {
  const double step = RoundStep((high - low) / count);
  const double largest = std::max(std::abs(low), std::abs(high));
  const int digits = 1 + std::max(0, static_cast<int>(std::floor(std::log10(largest / step))));
  std::vector<Tick> ticks;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    ticks.push_back({i * step, Readable(i * step, std::max(digits, 3))});
  }
  return ticks;
}

Scale::Scale(const Range& range, double from, double to, double margin)
    : low_(range.low()), high_(range.high()), from_(from), to_(to) {
  // Below a billionth of the magnitude, rounding would decide where the points lie.
  const double least = 1e-9 * std::max(std::abs(low_), std::abs(high_));
  const double pad = high_ - low_ > least ? margin * (high_ - low_)
                                          : std::max(0.5 * std::max(std::abs(low_), least), 1e-300);
  low_ -= pad;
  high_ += pad;
  if (low_ == high_ || high_ - low_ <= 1e-290) {
    low_ -= 1;
    high_ += 1;
  }
}

}  // namespace continuum::page
