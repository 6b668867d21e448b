#include "identification/diagnosis/deviations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "sim/io/rounded.h"
#include "sim/simulation/score.h"

namespace continuum {
namespace {

// RMS of y(t − shift) − measured over a stretch of rows.
double ShiftedError(const std::vector<double>& y, const std::vector<double>& measured, int shift) {
  double sum = 0, n = 0;
  const int rows = static_cast<int>(y.size());
  for (int k = std::max(0, shift); k < std::min(rows, rows + shift); ++k) {
    if (std::isnan(measured[k])) continue;
    const double e = y[k - shift] - measured[k];
    sum += e * e, n += 1;
  }
  return n > 0 ? std::sqrt(sum / n) : 0;
}

// "lags by 40 ms" when a shift in time alone halves the error.
std::string LagInWords(const Log& log, const std::vector<double>& y,
                       const std::vector<double>& measured) {
  const double period = (log.time.back() - log.time.front()) / static_cast<double>(log.rows() - 1);
  const int reach = static_cast<int>(std::min(0.25 / period, static_cast<double>(log.rows()) / 4));
  const double present = ShiftedError(y, measured, 0);
  double best = present;
  int at = 0;
  for (int s = -reach; s <= reach; ++s) {
    const double e = ShiftedError(y, measured, s);
    if (e < best) best = e, at = s;
  }
  if (at == 0 || best > 0.5 * present) return "";
  return fmt::format("{} the measurement by {:.0f} ms", at > 0 ? "runs ahead of" : "lags behind",
                     1000 * period * std::abs(at));
}

// "1.02-1.10 s" or "1.02 s": while a deviation stays above half its peak.
std::string WhenInWords(const Log& log, const std::vector<double>& residual, std::size_t peak) {
  std::size_t from = peak, to = peak;
  const auto large = [&](std::size_t k) { return residual[k] / residual[peak] > 0.5; };
  while (from > 0 && large(from - 1)) --from;
  while (to + 1 < log.rows() && large(to + 1)) ++to;
  if (from == to) return Fixed(log.time[peak], 2) + " s";
  return Fixed(log.time[from], 2) + "-" + Fixed(log.time[to], 2) + " s";
}

std::size_t Peak(const std::vector<double>& residual) {
  std::size_t peak = 0;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    if (!(std::abs(residual[k]) <= std::abs(residual[peak])) && !std::isnan(residual[k])) peak = k;
  }
  return peak;
}

struct SizedDeviation {
  double size;  // root mean square, in units of what the channel moves
  Deviation deviation;
};

SizedDeviation Largest(const Experiment& e, const Log& log, const Trace& trace, std::size_t c,
                       const std::vector<double>& residual, double size) {
  const auto& channel = e.channels[c];
  const std::size_t peak = Peak(residual);
  const std::string when = WhenInWords(log, residual, peak);
  const double off = residual[peak] / channel.factor;
  if (e.outputs[channel.output].quaternion()) {
    return {size,
            {log.label, e.channels[c + 1].name, when,
             fmt::format("is turned by {:.3g} rad about {}, in the axes measured", off,
                         "xyz"[channel.component])}};
  }
  std::string what =
      fmt::format("is {:.3g} {} too {}", std::abs(off), channel.unit, off > 0 ? "high" : "low");
  const std::string lag = LagInWords(log, trace.channel[c], log.measured[c]);
  if (!lag.empty()) what += "; over the whole log it " + lag;
  return {size, {log.label, channel.name, when, what}};
}

}  // namespace

std::vector<Deviation> FindDeviations(const Experiment& e, const std::vector<Trace>& simulated) {
  constexpr std::size_t kMost = 6;
  std::vector<SizedDeviation> all;
  const Pool pool(e);
  std::set<std::pair<std::string, std::string>> seen;  // replicates need no second mention
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Log& log = e.logs[l];
    if (!seen.insert({log.trial, log.condition}).second && log.window.empty()) continue;
    const auto residual = Residuals(e, log, simulated[l]);
    const auto score = ScoreLog(e, log, simulated[l]);
    for (std::size_t c = 0; c < e.channels.size(); ++c) {
      if (!pool.counts(c) || !(score[c].rmse > 0)) continue;
      const double size = score[c].rmse * e.channels[c].factor / pool.scale(c);
      all.push_back(Largest(e, log, simulated[l], c, residual[c], size));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.size > b.size; });
  std::vector<Deviation> largest;
  for (std::size_t i = 0; i < std::min(kMost, all.size()); ++i) largest.push_back(all[i].deviation);
  return largest;
}

}  // namespace continuum
