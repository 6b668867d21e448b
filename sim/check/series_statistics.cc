#include "sim/check/series_statistics.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace continuum {
namespace {

using Values = std::vector<double>;

constexpr std::size_t kHold = 30;  // rows: beyond this a constant value is a rest, not a refresh

double Ratio(std::size_t a, std::size_t b) {
  return static_cast<double>(a) / static_cast<double>(std::max<std::size_t>(b, 1));
}

// Median of |values| over rows around a row, without the rows next to it.
double Around(const Values& values, std::size_t row, std::size_t reach) {
  const std::size_t from = row > reach ? row - reach : 0;
  const std::size_t to = std::min(values.size(), row + reach + 1);
  Values near;
  for (std::size_t k = from; k < to; ++k) {
    if (k + 2 < row || k > row + 2) near.push_back(std::abs(values[k]));
  }
  return Median(std::move(near));
}

// A long constant stretch is suspicious only when the signal had to catch up afterwards.
bool CatchesUp(const Values& x, const Stretch& run, double quantum) {
  constexpr std::size_t kAfter = 5;  // rows
  if (run.end + kAfter >= x.size()) return false;
  double after = 0;
  for (std::size_t k = run.end + 1; k <= run.end + kAfter; ++k) after += std::abs(x[k] - x[k - 1]);
  const double step = std::abs(x[run.end] - x[run.end - 1]);
  return step >= std::max(3 * after / static_cast<double>(kAfter), 8 * quantum);
}

// On a coarse grid a turning signal may rest for a row; then it comes and goes in single steps.
bool StepsOver(const Values& x, const Stretch& run, double quantum) {
  const double before = std::abs(x[run.begin] - x[run.begin - 1]);
  const double after = std::abs(x[run.end] - x[run.end - 1]);
  return std::min(before, after) >= 2.5 * quantum;
}

// Whether a staircase follows a smooth course: most steps go the way of the step before.
bool FollowsACourse(const Values& x, const std::vector<Stretch>& runs) {
  std::size_t same = 0, all = 0;
  for (std::size_t i = 2; i < runs.size(); ++i) {
    const double before = x[runs[i - 1].begin] - x[runs[i - 2].begin];
    const double now = x[runs[i].begin] - x[runs[i - 1].begin];
    same += before * now > 0;
    ++all;
  }
  return Ratio(same, all) > 0.6;
}

// Whether rows scatter by more than the smoothness of a motion explains, and by more than a step.
bool IsNoisy(const Values& x, double quantum) {
  Values fourth;
  for (std::size_t k = 4; k < x.size(); ++k)
    fourth.push_back(std::abs(x[k] - 4 * x[k - 1] + 6 * x[k - 2] - 4 * x[k - 3] + x[k - 4]));
  const double noise = NoiseOf(x), rough = 1.4826 / std::sqrt(70.0) * Median(std::move(fourth));
  return noise > std::max(1e-5 * RangeOf(x), quantum) && rough > 0.5 * noise;
}

// Step of the grid on which all levels lie; 0 when there is none.
double GridOf(Values levels, double range) {
  std::sort(levels.begin(), levels.end());
  const auto same = [&](double a, double b) { return std::abs(a - b) <= 1e-9 * range; };
  levels.erase(std::unique(levels.begin(), levels.end(), same), levels.end());
  if (levels.size() < 8) return 0;
  const Values gaps = Differences(levels);
  const double smallest = Quantile(gaps, 0.02);
  double sum = 0, count = 0;
  std::size_t off_grid = 0;
  for (const double gap : gaps) {
    const double steps = std::round(gap / smallest);
    if (std::abs(gap / smallest - steps) > 0.1 || steps < 1) {
      ++off_grid;
    } else if (steps < 5) {
      sum += gap;
      count += steps;
    }
  }
  if (Ratio(off_grid, gaps.size()) > 0.15 || count == 0) return 0;
  const double quantum = sum / count;
  return range / quantum <= 2e4 ? quantum : 0;
}

}  // namespace

std::vector<Stretch> RunsOf(const Values& x) {
  std::vector<Stretch> runs;
  for (std::size_t k = 0; k < x.size();) {
    std::size_t end = k + 1;
    while (end < x.size() && x[end] == x[k]) ++end;
    runs.push_back({k, end});
    k = end;
  }
  return runs;
}

double Quantile(Values values, double q) {
  if (values.empty()) return 0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Values Differences(const Values& x) {
  Values d;
  for (std::size_t k = 1; k < x.size(); ++k) d.push_back(x[k] - x[k - 1]);
  return d;
}

double NoiseOf(const Values& x) {
  Values second;
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    second.push_back(std::abs(x[k + 1] - 2 * x[k] + x[k - 1]));
  }
  return 1.4826 / std::sqrt(6.0) * Median(std::move(second));
}

double RangeOf(const Values& x) {
  if (x.empty()) return 0;
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

std::size_t DistinctValues(const Values& x, std::size_t limit) {
  std::set<double> seen;
  for (const double v : x) {
    seen.insert(v);
    if (seen.size() >= limit) break;
  }
  return seen.size();
}

double QuantumOf(const Values& x) {
  // Values that come twice in a row are the sensor's own even in a log that was resampled.
  Values repeated;
  for (std::size_t k = 1; k < x.size(); ++k) {
    if (x[k] == x[k - 1]) repeated.push_back(x[k]);
  }
  const double range = RangeOf(x);
  const double quantum = GridOf(repeated, range);
  return quantum > 0 ? quantum : GridOf(x, range);
}

Refresh RefreshOf(const Values& x, double quantum, bool command) {
  Refresh r;
  r.repeated.assign(x.size(), false);
  const std::vector<Stretch> runs = RunsOf(x);
  if (runs.size() < 20 || DistinctValues(x, 8) < 8) return r;
  if (command && !FollowsACourse(x, runs)) return r;

  Values holds;
  for (const Stretch& run : runs) {
    if (run.size() <= kHold) holds.push_back(static_cast<double>(run.size()));
  }
  const auto reach =
      static_cast<std::size_t>(std::clamp(2 * Median(holds), 5.0, static_cast<double>(kHold)));
  if (x.size() < 4 * reach) return r;
  const double noise = NoiseOf(x), range = RangeOf(x);
  const double slow = std::max(quantum > 0 ? 3 * quantum + 4 * noise : 0, 1e-6 * range);
  std::vector<bool> moving(x.size(), false);
  for (std::size_t k = reach; k + reach <= x.size(); ++k) {
    const double course = std::abs(x[k + reach - 1] - x[k - reach]);
    moving[k] = course > slow * static_cast<double>(2 * reach - 1);
  }
  const bool never_equal = quantum == 0 && noise > 1e-5 * range;

  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  double sum = 0, squares = 0, count = 0;
  for (const Stretch& run : runs) {
    // Flat at an extreme is clipping.
    if (run.size() >= 5 && (x[run.begin] == *low || x[run.begin] == *high)) continue;
    const bool inner = run.begin > 0 && run.end < x.size();
    bool in_motion = false;
    for (std::size_t k = run.begin; k < run.end; ++k) in_motion |= moving[k];
    if (!inner || !in_motion) continue;
    const bool hold = run.size() > kHold;
    const bool brief = run.size() < 5 && (run.size() == 1 || StepsOver(x, run, quantum));
    const bool lasting =
        run.size() >= 5 && !(command && hold) && (never_equal || CatchesUp(x, run, quantum));
    if (!brief && !lasting) continue;
    for (std::size_t k = run.begin + 1; k < run.end; ++k) r.repeated[k] = true;
    if (run.size() > r.longest) r.longest = run.size(), r.longest_row = run.begin;
    if (hold) {
      r.frozen += run.size();
      continue;
    }
    r.moving += run.size();
    r.repeats += run.size() - 1;
    const auto rows = static_cast<double>(run.size());
    sum += rows, squares += rows * rows, count += 1;
  }
  if (count > 0) {
    r.interval = sum / count;
    r.spread = std::sqrt(std::max(squares / count - r.interval * r.interval, 0.0));
  }
  return r;
}

std::optional<Stretch> FrozenEnd(const Values& x, double quantum) {
  const auto runs = RunsOf(x);
  if (runs.size() < kHold) return std::nullopt;
  const bool first = runs.front().size() > runs.back().size();
  const Stretch longer = first ? runs.front() : runs.back();
  const auto clipped = [&](const Stretch& run) {  // the same value, elsewhere
    return run.size() >= 5 && run.begin != longer.begin && x[run.begin] == x[longer.begin];
  };
  if (std::any_of(runs.begin(), runs.end(), clipped)) return std::nullopt;
  const auto at = [&](std::size_t row) { return x.begin() + static_cast<std::ptrdiff_t>(row); };
  const Values rest(at(runs.front().end), at(runs.back().begin));
  return longer.size() > kHold && IsNoisy(rest, quantum) ? std::optional(longer) : std::nullopt;
}

double BendOf(const Values& x) {
  Values bends;
  for (std::size_t k = 1; k + 1 < x.size(); ++k)
    bends.push_back(std::abs(x[k + 1] - 2 * x[k] + x[k - 1]) / 2);
  return Median(std::move(bends));
}

std::vector<Jump> SpikesOf(const Values& x, double quantum, double usual_bend, bool command) {
  std::vector<Jump> jumps;
  if (x.size() < 10 || DistinctValues(x, 8) < 8) return jumps;
  const Values d = Differences(x);
  Values bend{0};  // of row k: half of the second difference
  for (std::size_t k = 1; k < d.size(); ++k) bend.push_back((d[k] - d[k - 1]) / 2);
  Values sizes;
  for (const double v : d) sizes.push_back(std::abs(v));
  const double everywhere = std::max(
      {20 * usual_bend, 8 * quantum, 1e-3 * RangeOf(x), command ? 4 * Quantile(sizes, 0.95) : 0.0});
  for (std::size_t k = 1; k < d.size(); ++k) {
    if (d[k - 1] * d[k] >= 0) continue;
    const double size = std::min(sizes[k - 1], sizes[k]);
    if (size <= everywhere || size < 0.5 * std::max(sizes[k - 1], sizes[k])) continue;
    if (size <= std::max(16 * Around(bend, k, 20), 5 * Around(d, k, 20))) continue;
    jumps.push_back({k, -bend[k]});
  }
  return jumps;
}

std::vector<Jump> StepsOf(const Values& x, double quantum, double usual_bend,
                          const std::vector<bool>& skip) {
  std::vector<Jump> jumps;
  if (x.size() < 10 || DistinctValues(x, 8) < 8) return jumps;
  const Values d = Differences(x);
  Values bends;
  for (std::size_t k = 1; k < d.size(); ++k) bends.push_back(std::abs(d[k] - d[k - 1]) / 2);
  const double everywhere = std::max({16 * usual_bend, 8 * quantum, 0.01 * RangeOf(x)});
  for (std::size_t k = 2; k + 2 < d.size(); ++k) {
    const double excess = d[k] - (d[k - 1] + d[k + 1]) / 2, size = std::abs(excess);
    if (size <= everywhere || skip[k + 1]) continue;
    const double beside = std::max({std::abs(d[k + 1] - d[k - 1]), std::abs(d[k - 1] - d[k - 2]),
                                    std::abs(d[k + 2] - d[k + 1])});
    if (size <= std::max(6 * beside, 16 * Around(bends, k, 20))) continue;
    jumps.push_back({k + 1, excess});
  }
  return jumps;
}

double Correlation(const Values& a, const Values& b, std::ptrdiff_t lag) {
  const auto n = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, lag);
  const std::ptrdiff_t to = n + std::min<std::ptrdiff_t>(0, lag);
  if (to - from < 2) return 0;
  const double a0 = a[from - lag], b0 = b[from];  // keeps large offsets from eating the digits
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::ptrdiff_t k = from; k < to; ++k) {
    const double u = a[k - lag] - a0, v = b[k] - b0;
    sa += u, sb += v, saa += u * u, sbb += v * v, sab += u * v;
  }
  const auto count = static_cast<double>(to - from);
  const double va = saa - sa * sa / count, vb = sbb - sb * sb / count;
  if (!(va > 1e-12 * saa) || !(vb > 1e-12 * sbb)) return 0;
  return (sab - sa * sb / count) / std::sqrt(va * vb);
}

double Deviation(const Values& x) {
  double sum = 0, squares = 0;
  for (const double v : x) sum += v;
  const double count = static_cast<double>(std::max<std::size_t>(x.size(), 1)), mean = sum / count;
  for (const double v : x) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / count);
}

std::optional<Lag> LagOf(const Values& a, const Values& b, std::ptrdiff_t least,
                         std::ptrdiff_t most, Sign sign) {
  const auto n = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  if (n < 4 * std::max<std::ptrdiff_t>({most, -least, 1})) return std::nullopt;
  Lag lag;
  lag.at_zero = Correlation(a, b);
  const auto height = [&](double correlation) {
    return sign == Sign::kAny ? std::abs(correlation)
                              : std::copysign(1.0, lag.at_zero) * correlation;
  };
  Values all;
  for (std::ptrdiff_t k = least; k <= most; ++k) all.push_back(Correlation(a, b, k));
  const auto peak = std::max_element(all.begin(), all.end(),
                                     [&](double x, double y) { return height(x) < height(y); });
  if (height(*peak) <= 0 || peak == all.begin() || peak + 1 == all.end()) return std::nullopt;
  const double left = height(peak[-1]), right = height(peak[1]);
  const double bend = 2 * height(*peak) - left - right;  // > 0: curvature at the peak
  lag.rows = static_cast<double>(least + (peak - all.begin()));
  if (bend > 0) lag.rows += 0.5 * (right - left) / bend;
  lag.correlation = *peak;
  lag.slope = std::copysign(Deviation(b) / Deviation(a), *peak);
  const double noise = std::max(1 - *peak * *peak, 0.0);
  lag.sd = std::sqrt(10 * noise / (static_cast<double>(n) * std::max(bend, 1e-12)));
  return lag;
}

}  // namespace continuum
