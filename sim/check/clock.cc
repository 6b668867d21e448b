#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;

void ReportGaps(const std::vector<double>& time, std::vector<std::size_t> gaps, double period,
                Findings& out) {
  const auto length = [&](std::size_t k) { return time[k + 1] - time[k]; };
  const std::size_t count = gaps.size();
  std::stable_sort(gaps.begin(), gaps.end(),
                   [&](std::size_t a, std::size_t b) { return length(a) > length(b); });
  const auto place = [&](std::size_t k) {
    return fmt::format("{:.4g} s after t = {}", length(k), Clock(time[k]));
  };
  out.Add(Severity::kWarning, "", "gap",
          fmt::format("the clock has gaps after {} of {} rows, which are {:.4g} s apart: {}; the "
                      "inputs are held over a gap, windows beside it begin anew",
                      count, time.size(), period, place(gaps.front())),
          time[gaps.front()], time[gaps.front() + 1], FurtherPlaces(gaps, count, place));
}

void ReportJitter(const std::vector<double>& time, const std::vector<double>& steps, double period,
                  Findings& out) {
  double squares = 0, largest = 0;
  std::size_t where = 0;
  double count = 0;
  const double gap = 2.5 * period;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (steps[k] > gap) continue;
    const double off = std::abs(steps[k] - period);
    squares += off * off;
    count += 1;
    if (off > largest) largest = off, where = k;
  }
  const double jitter = std::sqrt(squares / std::max(count, 1.0)) / period;
  const bool bad = jitter > 0.02 || largest > 0.2 * period;
  const bool exact = largest < 1e-6 * period;
  const std::string text =
      fmt::format("{} rows over {:.4g} s, {:.4g} s apart ({:.4g} Hz)", time.size(),
                  time.back() - time.front(), period, 1 / period) +
      (exact ? ""
             : fmt::format("; the clock jitters by {:.2g} % rms, at most by {:.2g} s at t = {}",
                           100 * jitter, largest, Clock(time[where])));
  if (bad) {
    out.Add(Severity::kWarning, "", "clock_jitter", text);
  } else {
    out.Add(Severity::kInfo, "", "clock", text);
  }
}

// One log in milliseconds among others in seconds, or all of them in milliseconds.
void CheckUnit(const CheckedLog& log, Findings& out) {
  constexpr double kSlow = 1;  // [s] between rows: ms at 1 kHz, read as s
  const Experiment& e = *log.experiment;
  if (log.period >= kSlow && log.usual_period >= kSlow && e.time_unit == "s" && !e.quasi_static) {
    out.Add(Severity::kWarning, "", "unit_suspect",
            fmt::format("its rows are {:.3g} s apart: are these times in ms?", log.period));
  }
  const double ratio = log.period / log.usual_period;
  for (const double factor : {1e3, 1e-3, 1e6, 1e-6}) {
    if (std::abs(std::log(ratio / factor)) > std::log(1.5)) continue;
    out.Add(Severity::kWarning, "", "unit_suspect",
            fmt::format("its rows are {:.3g} s apart, {:.4g} times as far as those of the other "
                        "logs: is its time in another unit?",
                        log.period, ratio));
  }
}

}  // namespace

void CheckClock(const CheckedLog& log, Findings& out) {
  const auto& time = log.log->time;
  const std::vector<double> steps = Differences(time);
  if (steps.empty()) return;
  const auto back = std::find_if(steps.begin(), steps.end(), [](double d) { return !(d > 0); });
  if (back != steps.end()) {
    const double t = time[back - steps.begin()];
    out.Add(Severity::kError, "", "clock", fmt::format("time does not increase after {:.6g} s", t),
            t, t);
    return;
  }
  // An irregular clock is jitter, not a series of gaps.
  const double missing = std::max(2.5 * log.period, 1.5 * Quantile(steps, 0.9));
  std::vector<std::size_t> gaps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (steps[k] > missing) gaps.push_back(k);
  }
  if (!gaps.empty()) ReportGaps(time, gaps, log.period, out);
  ReportJitter(time, steps, log.period, out);
  CheckUnit(log, out);
}

}  // namespace continuum
