#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;
using Values = std::vector<double>;

// Stretches at an extreme value.
struct Clipping {
  std::size_t rows = 0, runs = 0, first_row = 0, last_row = 0;

  void Add(const Stretch& run) {
    if (runs == 0) first_row = run.begin;
    last_row = run.end - 1;
    rows += run.size();
    ++runs;
  }
};

double Extreme(const Values& x, bool upper) {
  return upper ? *std::max_element(x.begin(), x.end()) : *std::min_element(x.begin(), x.end());
}

// Those that the signal enters at speed, over several rows: neither a rest nor a step.
Clipping EnteredAtSpeed(const CheckedColumn& c, bool upper) {
  const Values& x = c.value;
  const double extreme = Extreme(x, upper), range = RangeOf(x);
  Values sizes;
  for (const double v : Differences(x)) sizes.push_back(std::abs(v));
  const double fast = std::max(3 * c.quantum, 0.25 * Quantile(sizes, 0.95));
  Clipping clip;
  for (const Stretch& run : RunsOf(x)) {
    if (x[run.begin] != extreme || run.size() < 5 || run.begin < 3) continue;
    const double last = std::abs(x[run.begin - 1] - x[run.begin - 2]);
    const double before = std::abs(x[run.begin - 2] - x[run.begin - 3]);
    if (std::min(last, before) < fast) continue;
    if (last * static_cast<double>(run.size()) >= 0.02 * range) clip.Add(run);
  }
  return clip;
}

// Those of a command that is at its extreme in many rows, and nowhere else nearly as often: however
// it moves in between.
Clipping PiledUp(const CheckedColumn& c, bool upper) {
  const double extreme = Extreme(c.value, upper), other = Extreme(c.value, !upper);
  Clipping clip;
  for (const Stretch& run : RunsOf(c.value)) {
    if (c.value[run.begin] == extreme) clip.Add(run);
  }
  std::map<double, std::size_t> counts;
  for (const double v : c.value) {
    if (v != extreme && v != other) ++counts[v];
  }
  std::size_t most = 1;
  for (const auto& [value, count] : counts) most = std::max(most, count);
  const bool many = clip.runs >= 3 && 20 * clip.rows >= c.value.size() && clip.rows >= 4 * most;
  return extreme != 0 && many ? clip : Clipping{};  // 0: a cable or chamber that is let go
}

void Report(const CheckedColumn& c, const Clipping& clip, bool upper, const char* how,
            Findings& out) {
  out.Add(c.input ? Severity::kInfo : Severity::kWarning, c.name, "saturation",
          fmt::format("stays flat at its {} value {} for {:.2g} % of the rows ({} time{}, {}): {}",
                      upper ? "largest" : "smallest", Amount(c.value[clip.first_row], c.unit),
                      100 * static_cast<double>(clip.rows) / static_cast<double>(c.value.size()),
                      clip.runs, clip.runs == 1 ? "" : "s", how,
                      c.input ? "saturated, or held there on purpose" : "it looks saturated"),
          c.time[clip.first_row], c.time[clip.last_row]);
}

}  // namespace

void CheckSaturation(const CheckedColumn& c, Findings& out) {
  if (c.value.size() < 20 || DistinctValues(c.value, 8) < 8) return;
  for (const bool upper : {false, true}) {
    const Clipping fast = EnteredAtSpeed(c, upper);
    const Clipping piled = c.input ? PiledUp(c, upper) : Clipping{};
    if (fast.runs > 0)
      Report(c, fast, upper, "entered at speed", out);
    else if (piled.runs > 0)
      Report(c, piled, upper, "no other value is there as often", out);
  }
}

}  // namespace continuum
