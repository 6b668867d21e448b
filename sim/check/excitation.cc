#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;

// Turning points larger than 5 % of the range.
int Reversals(const std::vector<double>& x) {
  const double dead = 0.05 * RangeOf(x);
  int count = 0, direction = 0;
  double turn = x.front();
  for (const double v : x) {
    if (direction == 0) {
      if (std::abs(v - turn) > dead) direction = v > turn ? 1 : -1, turn = v;
    } else if ((v - turn) * direction > 0) {
      turn = v;
    } else if ((turn - v) * direction > dead) {
      direction = -direction;
      turn = v;
      ++count;
    }
  }
  return count;
}

// Longest stretch within 0.1 % of the range and two quantisation steps.
double LongestRest(const CheckedColumn& c) {
  const double still = 1e-3 * RangeOf(c.value) + 2 * c.quantum;
  double longest = 0, low = c.value.front(), high = low, begin = c.time.front();
  for (std::size_t k = 0; k < c.value.size(); ++k) {
    low = std::min(low, c.value[k]);
    high = std::max(high, c.value[k]);
    if (high - low > still) low = high = c.value[k], begin = c.time[k];
    longest = std::max(longest, c.time[k] - begin);
  }
  return longest;
}

}  // namespace

void CheckExcitation(const CheckedLog& log, Findings& out) {
  double rest = 1e300;
  bool driven = false;
  for (const CheckedColumn& c : log.columns) {
    if (!c.input || c.constant()) continue;
    driven = true;
    const double still = LongestRest(c);
    rest = std::min(rest, still);
    const int reversals = Reversals(c.value);
    const auto [low, high] = std::minmax_element(c.value.begin(), c.value.end());
    out.Add(
        Severity::kInfo, c.name, "excitation",
        fmt::format("moves between {} and {} with {} reversal{}; its longest rest is {:.2g} s{}",
                    Amount(*low, c.unit), Amount(*high, c.unit), reversals,
                    reversals == 1 ? "" : "s", still,
                    reversals == 0 ? ": friction and hysteresis, which show when the direction "
                                     "turns, cannot be distinguished from stiffness"
                                   : ""));
  }
  if (!driven) {
    out.Add(Severity::kInfo, "", "excitation", "no input moves: a free motion");
  } else if (rest <
             std::max(20 * log.period, 0.02 * (log.log->time.back() - log.log->time.front()))) {
    out.Add(Severity::kInfo, "", "excitation",
            "the inputs never rest together: static friction and a bias cannot be distinguished");
  }
}

}  // namespace continuum
