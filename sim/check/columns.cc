#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;

// The columns that miss the same rows as one: a tracker that is lost loses all at once.
std::vector<std::size_t> Together(const CheckedLog& log, std::size_t column) {
  std::vector<std::size_t> together;
  for (std::size_t i = 0; i < log.columns.size(); ++i) {
    if (log.columns[i].row == log.columns[column].row) together.push_back(i);
  }
  return together;
}

void CheckMissing(const CheckedLog& checked, std::size_t column, Findings& out) {
  const CheckedColumn& c = checked.columns[column];
  const Log& log = *checked.log;
  if (c.missing == 0) return;
  const auto together = Together(checked, column);
  if (together.front() < column) return;  // told beside that one
  std::string others;
  for (std::size_t i = 1; i < together.size(); ++i)
    others += (i == 1 ? "; so it is with " : ", ") + checked.columns[together[i]].name;
  std::size_t longest = 0, begin = 0;
  for (std::size_t i = 0; i <= c.row.size(); ++i) {
    const std::size_t from = i == 0 ? 0 : c.row[i - 1] + 1;
    const std::size_t to = i == c.row.size() ? log.rows() : c.row[i];
    if (to - from > longest) longest = to - from, begin = from;
  }
  const double share = 100 * static_cast<double>(c.missing) / static_cast<double>(log.rows());
  out.Add(share > 5 ? Severity::kWarning : Severity::kInfo, c.name, "nan",
          fmt::format("{:.3g} % of the values are missing ({} of {} rows); the longest stretch has "
                      "{} rows from t = {}{}",
                      share, c.missing, log.rows(), longest, Clock(log.time[begin]), others),
          log.time[begin], log.time[begin + longest - 1]);
}

bool CheckVariance(const CheckedColumn& c, Findings& out) {
  if (!c.constant()) return true;
  const auto severity = c.input ? Severity::kInfo : Severity::kWarning;
  out.Add(severity, c.name, "no_variance",
          fmt::format("no variance: every value is {}, so it has no information{}",
                      Amount(c.value.empty() ? 0 : c.value.front(), c.unit),
                      c.input ? "" : " but that this does not move"));
  return false;
}

void CheckQuantum(const CheckedColumn& c, Findings& out) {
  if (c.quantum == 0) return;
  const double levels = RangeOf(c.value) / c.quantum;
  const bool coarse = !c.input && levels < 10;
  out.Add(
      coarse ? Severity::kWarning : Severity::kInfo, c.name, "quantisation",
      fmt::format("values come in steps of {}, {:.0f} of them over the range: a noise floor of "
                  "{} rms",
                  Amount(c.quantum, c.unit), levels, Amount(c.quantum / std::sqrt(12.0), c.unit)));
}

// A sensor that froze before the log ended, or woke after it began.
bool CheckFrozenEnd(const CheckedColumn& c, Findings& out) {
  const auto frozen = c.input ? std::nullopt : FrozenEnd(c.value, c.quantum);
  if (!frozen) return false;
  const std::string where =
      frozen->begin == 0 ? fmt::format("up to t = {}", Clock(c.time[frozen->end - 1]))
                         : fmt::format("from t = {} to the end", Clock(c.time[frozen->begin]));
  out.Add(Severity::kWarning, c.name, "stale",
          fmt::format("stale: keeps one value {}, {} of {} rows, and is noisy elsewhere", where,
                      frozen->size(), c.value.size()),
          c.time[frozen->begin], c.time[frozen->end - 1]);
  return true;
}

// The values without those that only repeat the one before.
CheckedColumn Fresh(const CheckedColumn& c) {
  CheckedColumn fresh = c;
  fresh.time.clear(), fresh.value.clear(), fresh.row.clear();
  for (std::size_t k = 0; k < c.value.size(); ++k) {
    if (k > 0 && c.value[k] == c.value[k - 1]) continue;
    fresh.time.push_back(c.time[k]);
    fresh.value.push_back(c.value[k]);
    fresh.row.push_back(c.row[k]);
  }
  return fresh;
}

void CheckJumps(const CheckedColumn& c, const std::vector<bool>& disturbed, Findings& out) {
  const double bend = std::max(c.bend, BendOf(c.value));
  std::vector<Jump> jumps = SpikesOf(c.value, c.quantum, bend, c.input);
  // A short pulse of an input may show in a fast sensor.
  const double large = 0.25 * RangeOf(c.value);
  jumps.erase(std::remove_if(jumps.begin(), jumps.end(),
                             [&](const Jump& j) {
                               return !c.input && disturbed[c.row[j.row]] &&
                                      std::abs(j.size) < large;
                             }),
              jumps.end());
  if (c.smooth) {
    std::vector<bool> skip(c.row.size(), false);
    const double hole = 1.5 * Median(Differences(c.time));
    for (std::size_t k = 1; k < c.row.size(); ++k) {
      skip[k] = skip[k] || c.time[k] - c.time[k - 1] > hole;
      for (std::size_t r = c.row[k - 1] + 1; r <= c.row[k]; ++r) skip[k] = skip[k] || disturbed[r];
    }
    for (const Jump& step : StepsOf(c.value, c.quantum, bend, skip)) {
      const bool known = std::any_of(jumps.begin(), jumps.end(), [&](const Jump& j) {
        return j.row == step.row || j.row + 1 == step.row;
      });
      if (!known) jumps.push_back(step);
    }
  }
  if (jumps.empty()) return;
  const std::size_t count = jumps.size();
  std::stable_sort(jumps.begin(), jumps.end(), [](const Jump& a, const Jump& b) {
    return std::abs(a.size) > std::abs(b.size);
  });
  const auto place = [&](const Jump& j) {
    return fmt::format("{} in row {} (t = {})", Amount(j.size, c.unit), c.row[j.row] + 1,
                       Clock(c.time[j.row]));
  };
  const double t = c.time[jumps.front().row];
  out.Add(Severity::kWarning, c.name, "jump",
          fmt::format("jumps far out of its neighbours' range in {} of {} rows, most by {}", count,
                      c.row.size(), place(jumps.front())),
          t, t, FurtherPlaces(jumps, count, place));
}

void ReportRefresh(const CheckedColumn& c, const Refresh& r, bool often, Findings& out) {
  const auto first = std::find(r.repeated.begin(), r.repeated.end(), true) - r.repeated.begin();
  const auto last = r.repeated.rend() - std::find(r.repeated.rbegin(), r.repeated.rend(), true) - 1;
  const std::string longest =
      fmt::format("the longest stretch with one value has {} rows from t = {}", r.longest,
                  Clock(c.time[r.longest_row]));
  if (!often) {
    out.Add(
        Severity::kWarning, c.name, "stale",
        fmt::format("stale: keeps one value and then leaps, {} rows in all; {}", r.frozen, longest),
        c.time[r.longest_row], c.time[r.longest_row + r.longest - 1]);
  } else if (r.share() < 0.45) {
    out.Add(Severity::kWarning, c.name, "repeated",
            fmt::format("{:.2g} % of the samples in motion repeat the one before ({} of {}); {}",
                        100 * r.share(), r.repeats, r.moving, longest),
            c.time[first], c.time[last]);
  } else {
    const bool regular = r.spread < 0.3;
    // A command that is set at a lower rate than the log's is held there by design.
    const bool held = c.input && regular;
    const std::string how =
        regular ? "" : fmt::format(", irregularly (spread {:.1f} rows)", r.spread);
    out.Add(held ? Severity::kInfo : Severity::kWarning, c.name, "stale",
            fmt::format("{} while other columns move: values are refreshed about every {:.1f} rows"
                        "{}; {}",
                        held ? "held" : "stale", r.interval, how, longest),
            c.time[first], c.time[last]);
  }
}

// Rows in which every column repeats the row before, although some were moving.
std::vector<std::size_t> DuplicatedRows(const CheckedLog& log,
                                        const std::vector<Refresh>& refresh) {
  const std::size_t rows = log.log->rows();
  std::vector<bool> suspicious(rows, false), changed(rows, false);
  for (std::size_t i = 0; i < log.columns.size(); ++i) {
    const CheckedColumn& c = log.columns[i];
    for (std::size_t k = 1; k < c.row.size(); ++k) {
      if (c.value[k] != c.value[k - 1]) changed[c.row[k]] = true;
      if (refresh[i].repeated[k]) suspicious[c.row[k]] = true;
    }
  }
  std::vector<std::size_t> duplicated;
  for (std::size_t k = 1; k < rows; ++k) {
    if (suspicious[k] && !changed[k]) duplicated.push_back(k);
  }
  // More than that is a slow sensor, not a row written twice.
  if (4 * duplicated.size() > rows) duplicated.clear();
  return duplicated;
}

void ReportDuplicates(const Log& log, const std::vector<std::size_t>& rows, Findings& out) {
  const auto place = [&](std::size_t row) {
    return fmt::format("{} (t = {})", row + 1, Clock(log.time[row]));
  };
  out.Add(Severity::kWarning, "", "duplicated_rows",
          fmt::format("{} of {} rows repeat the row before in every column: row {}", rows.size(),
                      log.rows(), place(rows.front())),
          log.time[rows.front()], log.time[rows.back()], FurtherPlaces(rows, rows.size(), place));
}

// A unit that the size of the values makes unlikely.
void CheckMagnitude(const CheckedColumn& c, Findings& out) {
  const double range = RangeOf(c.value);
  if (c.unit == "m" && range > 20) {
    out.Add(Severity::kInfo, c.name, "unit_suspect",
            fmt::format("the values span {:.3g} m: are they millimetres?", range));
  } else if (c.unit == "rad" && range > 20) {
    out.Add(Severity::kInfo, c.name, "unit_suspect",
            fmt::format("the values span {:.3g} rad ({:.2g} turns): are they degrees?", range,
                        range / 6.2831853));
  }
}

}  // namespace

void CheckColumns(const CheckedLog& log, Findings& out) {
  std::vector<Refresh> refresh;
  for (const CheckedColumn& c : log.columns)
    refresh.push_back(RefreshOf(c.value, c.quantum, c.input));
  const std::vector<std::size_t> duplicated = DuplicatedRows(log, refresh);
  if (!duplicated.empty()) ReportDuplicates(*log.log, duplicated, out);

  for (std::size_t i = 0; i < log.columns.size(); ++i) {
    const CheckedColumn& c = log.columns[i];
    CheckMissing(log, i, out);
    if (!CheckVariance(c, out)) continue;
    CheckQuantum(c, out);
    if (!CheckFrozenEnd(c, out)) CheckSaturation(c, out);
    CheckMagnitude(c, out);
    const Refresh& r = refresh[i];
    std::size_t known = 0;  // repeats that are duplicated rows
    for (const std::size_t row : duplicated) {
      const auto k = std::lower_bound(c.row.begin(), c.row.end(), row) - c.row.begin();
      known += static_cast<std::size_t>(k) < c.row.size() && c.row[k] == row && r.repeated[k];
    }
    // A command may hold a level now and then.
    const bool often = r.repeats >= 5 && r.share() >= (c.input ? 0.3 : 0.005);
    if ((often || r.frozen > 0) && 2 * known <= r.repeats + r.frozen)
      ReportRefresh(c, r, often, out);
    if (!CheckWrapped(c, out)) CheckJumps(r.share() > 0.1 ? Fresh(c) : c, log.disturbed, out);
  }
}

}  // namespace continuum
