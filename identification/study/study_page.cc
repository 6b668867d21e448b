#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "identification/study/summary.h"
#include "sim/io/rounded.h"
#include "sim/page/page.h"

namespace continuum {
namespace {

using State = RowStatus::State;
using Rows = std::vector<std::vector<std::string>>;

std::string Short(double value) { return std::isfinite(value) ? Significant(value, 4) : ""; }

std::string Interval(double low, double high) {
  return std::isfinite(low) && std::isfinite(high)
             ? Significant(low, 3) + " … " + Significant(high, 3)
             : "";
}

// "12 s", "3.2 min", "5.1 h".
std::string Duration(double seconds) {
  if (seconds < 120) return fmt::format("{:.3g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.3g} min", seconds / 60);
  return fmt::format("{:.3g} h", seconds / 3600);
}

std::string ErrorInWords(const RowResult& r) {
  const double before = std::isfinite(r.validate) ? r.validate : r.train;
  if (!std::isfinite(before)) return "";
  if (std::isfinite(r.validate_after))
    return fmt::format("{} → {} {}", Short(before), Short(r.validate_after), r.unit);
  return Short(before) + " " + r.unit;
}

class StudyPage {
 public:
  explicit StudyPage(const StudySummary& summary)
      : summary_(summary), page_("Study", summary.study->name) {}

  Page Make() && {
    AddCounts();
    AddNotDone();
    page_.Heading("Rows");
    AddRows();
    AddCauses();
    AddPopulations();
    return std::move(page_);
  }

 private:
  void AddCounts() {
    double seconds = 0;
    for (const StudyLine& line : summary_.lines) {
      if (line.status.record) seconds += line.status.record->seconds;
    }
    const bool all = summary_.Count(State::kDone) == summary_.lines.size();
    page_.Badge(all                                  ? Tone::kGood
                : summary_.Count(State::kFailed) > 0 ? Tone::kBad
                                                     : Tone::kWarn,
                summary_.InWords(),
                "Time of all rows together: " + Duration(seconds) + "." + OddInWords());
  }

  // " Odd units: arm_17 (b, J)."
  std::string OddInWords() const {
    std::map<std::string, std::vector<std::string>> parameters;
    for (const Population& p : summary_.populations) {
      for (const std::string& unit : OddUnits(p, summary_.lines))
        parameters[unit].push_back(p.name);
    }
    std::string text;
    for (const auto& [unit, of] : parameters)
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", unit, fmt::join(of, ", "));
    return text.empty() ? "" : " Odd units: " + text + ".";
  }

  // Failures first.
  void AddNotDone() {
    Rows rows;
    std::vector<std::string> links;
    for (const State state : {State::kFailed, State::kChanged}) {
      for (const StudyLine& line : summary_.lines) {
        if (line.status.state != state) continue;
        const bool ran = state == State::kFailed && line.status.record;
        rows.push_back({std::to_string(line.row->number), line.row->name, StateName(state),
                        line.status.reason});
        links.push_back(ran ? FailedName(*line.row) + "/" : "");
      }
    }
    if (rows.empty()) return;
    page_.Heading("Rows that are not done");
    TableOptions options{"A link leads to the folder of the run that failed, with its messages."};
    options.links[1] = links;
    page_.Table({"row", "name", "status", "reason"}, rows, options);
  }

  std::vector<std::string> CellsOf(const StudyLine& line) const {
    const RowResult& r = line.result;
    std::vector<std::string> cells{
        std::to_string(line.row->number),
        line.row->name,
        StateName(line.status.state),
        VerdictInWords(r),
        r.cause.empty() ? line.status.reason : r.cause,
        GainInWords(r),
        ErrorInWords(r),
        line.status.record ? fmt::format("{:.1f}", line.status.record->seconds) : "",
        line.row->command};
    for (const std::string& label : summary_.study->labels) {
      const auto found = line.row->labels.find(label);
      cells.push_back(found == line.row->labels.end() ? "" : found->second);
    }
    return cells;
  }

  void AddRows() {
    std::vector<const StudyLine*> order;
    for (const StudyLine& line : summary_.lines) order.push_back(&line);
    std::stable_partition(order.begin(), order.end(), [](const StudyLine* line) {
      return line->status.state == State::kFailed;
    });
    std::vector<std::string> header{
        "row",         "name",  "status",   "verdict", "cause, or reason",
        "gain [95 %]", "error", "time [s]", "command"};
    for (const std::string& label : summary_.study->labels) header.push_back(label);
    Rows rows;
    page_.Paragraph(
        "Gain: the share of the error on validate logs that the extension removes. Error: RMS of "
        "the validate logs (else of the train logs), before → after the extension. A click on a "
        "column's head sorts. Point at a cell that is cut to read it.");
    TableOptions options;
    options.sortable = true;
    for (const StudyLine* const line : order) {
      if (line->status.state == State::kFailed) options.highlighted_rows.push_back(rows.size());
      rows.push_back(CellsOf(*line));
      options.links[1].push_back(
          line->result.page.empty() ? "" : line->row->name + "/" + line->result.page);
    }
    DropEmptyColumns(header, rows, options);
    page_.Table(header, rows, options);
  }

  // Gains of a study that only replays.
  static void DropEmptyColumns(std::vector<std::string>& header, Rows& rows,
                               TableOptions& options) {
    for (std::size_t c = header.size(); c-- > 2;) {
      const auto empty = [&](const auto& row) { return row[c].empty(); };
      if (!std::all_of(rows.begin(), rows.end(), empty)) continue;
      const auto at = static_cast<std::ptrdiff_t>(c);
      header.erase(header.begin() + at);
      for (auto& row : rows) row.erase(row.begin() + at);
    }
    options.links.begin()->second.resize(rows.size());
  }

  void AddCauses() {
    std::map<std::string, std::vector<std::string>> rows_of;
    for (const StudyLine& line : summary_.lines) {
      for (const std::string& effect : line.result.effects)
        rows_of[effect].push_back(line.row->name);
    }
    if (rows_of.empty()) return;
    Rows rows;
    for (const auto& [effect, names] : rows_of)
      rows.push_back(
          {effect, std::to_string(names.size()), fmt::format("{}", fmt::join(names, ", "))});
    std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) {
      return rows_of[a[0]].size() > rows_of[b[0]].size();
    });
    page_.Heading("Causes");
    page_.Table({"cause", "rows", "which"}, rows);
  }

  void AddPopulations() {
    if (summary_.populations.empty()) return;
    page_.Heading("Parameters across units");
    page_.Paragraph(
        "Each dot is a unit with the 95 % interval of its fit. The band is the mean ± the standard "
        "deviation between units, by Paule and Mandel's method. An odd unit lies off all others. "
        "By "
        "chance one parameter in twenty has such a unit.");
    AddPopulationTable();
    for (const Population& p : summary_.populations) AddUnits(p);
  }

  void AddPopulationTable() {
    Rows rows;
    for (const Population& p : summary_.populations) {
      const RandomEffects& s = p.spread;
      const auto odd = OddUnits(p, summary_.lines);
      rows.push_back({p.model, p.name, p.unit, std::to_string(p.units.size()), Short(s.mean),
                      Interval(s.mean_low, s.mean_high), Short(s.between),
                      Interval(s.between_low, s.between_high),
                      s.mean == 0 ? "" : Percent(s.between / std::abs(s.mean), 1),
                      fmt::format("{}", fmt::join(odd, ", "))});
      if (!p.left_out.empty()) rows.back()[3] += fmt::format(" (+{} left out)", p.left_out.size());
    }
    TableOptions options{
        "Between units: standard deviation of the units' true values. Left out: at a bound, "
        "or without an interval."};
    options.sortable = true;
    page_.Table({"model", "parameter", "unit", "units", "mean", "95 %", "between units", "95 %",
                 "of the mean", "odd"},
                rows, options);
  }

  void AddUnits(const Population& p) {
    const RandomEffects& s = p.spread;
    IntervalsSpec plot{p.name + " of " + p.model, {p.name, p.unit}, {}};
    plot.low = s.mean - s.between;
    plot.high = s.mean + s.between;
    plot.marks.push_back({"mean ± between units", s.mean});
    for (const PopulationUnit& u : p.units)
      plot.rows.push_back({summary_.lines[u.line].row->name, u.parameter.value, u.parameter.low,
                           u.parameter.high, u.deviation.odd});
    std::stable_sort(plot.rows.begin(), plot.rows.end(),
                     [](const IntervalRow& a, const IntervalRow& b) { return a.value < b.value; });
    page_.Intervals(plot);
  }

  const StudySummary& summary_;
  Page page_;
};

}  // namespace

void WriteStudyPage(const StudySummary& summary, const std::filesystem::path& file) {
  StudyPage(summary).Make().Write(file);
}

}  // namespace continuum
