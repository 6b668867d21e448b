#include "sim/page/time_series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/page/text.h"

namespace continuum::page {
namespace {

struct Stretch {
  std::size_t begin, end;
};

void KeepExtremes(const std::vector<double>& values, Stretch stretch,
                  std::vector<std::size_t>& kept) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t low = kNone, high = kNone, gap = kNone;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    if (!std::isfinite(values[i])) {
      if (gap == kNone) gap = i;
      continue;
    }
    if (low == kNone || values[i] < values[low]) low = i;
    if (high == kNone || values[i] > values[high]) high = i;
  }
  for (const std::size_t row : {low, high, gap}) {
    if (row != kNone) kept.push_back(row);
  }
}

// Digits that resolve a millionth of the span of the values.
int Digits(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double largest = std::max(std::abs(low), std::abs(high));
  if (!(high - low > 0) || !(largest > 0)) return 6;
  return std::clamp(6 + static_cast<int>(std::ceil(std::log10(largest / (high - low)))), 6, 15);
}

template <class Values>
std::string Array(const Values& values) {
  std::string out = "[";
  for (const auto& value : values) {
    if (out.size() > 1) out += ',';
    out += value;
  }
  return out + "]";
}

std::string Values(const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  const int digits = Digits(values);
  std::vector<std::string> texts;
  texts.reserve(rows.size());
  for (const std::size_t row : rows) {
    texts.push_back(std::isfinite(values[row]) ? Compact(values[row], digits) : "null");
  }
  return Array(texts);
}

// [start, step] of an even clock, otherwise every time.
std::string Times(const std::vector<double>& time, const std::vector<std::size_t>& rows) {
  const std::size_t last = rows.size() - 1;
  const double start = time[rows[0]];
  const double step = last > 0 ? (time[rows[last]] - start) / static_cast<double>(last) : 0;
  bool even = true;
  for (std::size_t i = 0; i <= last; ++i) {
    even = even && std::abs(time[rows[i]] - start - static_cast<double>(i) * step) <= 1e-6 * step;
  }
  if (even) return fmt::format("\"start\":{},\"step\":{}", Compact(start, 15), Compact(step, 15));
  return "\"time\":" + Values(time, rows);
}

}  // namespace

std::vector<std::size_t> Decimate(const std::vector<Series>& series, std::size_t rows,
                                  std::size_t limit) {
  std::vector<std::size_t> kept(rows);
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  if (rows <= limit) return kept;
  kept = {0, rows - 1};
  const std::size_t stretches = std::max<std::size_t>(limit / (3 * series.size()), 1);
  for (std::size_t s = 0; s < stretches; ++s) {
    const Stretch stretch{s * rows / stretches, (s + 1) * rows / stretches};
    for (const Series& one : series) KeepExtremes(one.values, stretch, kept);
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

std::string SeriesJson(const TimeSeriesSpec& spec, const std::vector<std::size_t>& rows,
                       int group) {
  std::vector<std::string> styles, values;
  for (std::size_t i = 0; i < spec.series.size(); ++i) {
    styles.push_back(fmt::format("\"{}\"", StyleName(spec.series[i].style, i)));
    values.push_back(Values(spec.series[i].values, rows));
  }
  return fmt::format("{{\"group\":{},{},\"styles\":{},\"values\":{}}}", group,
                     Times(spec.time, rows), Array(styles), Array(values));
}

}  // namespace continuum::page
