#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "sim/page/axis_scale.h"
#include "sim/page/plots.h"
#include "sim/page/svg.h"
#include "sim/page/text.h"

namespace continuum::page {
namespace {

constexpr std::size_t kMostLabels = 60;
constexpr double kTop = 24, kLabelled = 19, kPlain = 5;  // [px], heights of rows

Range IntervalRange(const IntervalsSpec& spec) {
  Range range;
  for (const IntervalRow& row : spec.rows) {
    range.Add(row.value);
    range.Add(row.low);
    range.Add(row.high);
  }
  if (range.empty()) return range;
  range.Add(spec.low);
  range.Add(spec.high);
  for (const Mark& mark : spec.marks) range.Add(mark.value);
  return range;
}

std::string RowHtml(const IntervalRow& row, const Scale& x, double y, double radius) {
  const char* const chosen = row.highlighted ? " chosen" : "";
  std::string out;
  if (std::isfinite(row.low) && std::isfinite(row.high))
    out += Line(row.highlighted ? "error chosen" : "error", x(row.low), y, x(row.high), y);
  if (!std::isfinite(row.value)) return out;
  return out + fmt::format(
                   "<circle class=\"point{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\">"
                   "<title>{}: {}</title></circle>\n",
                   chosen, x(row.value), y, radius, Escape(row.label), Compact(row.value));
}

std::string LabelHtml(const IntervalRow& row, double left, double y) {
  const auto length = static_cast<std::size_t>((left - 12) / 7);
  return fmt::format("<g><title>{}</title>{}</g>\n", Escape(row.label),
                     Text(row.highlighted ? "label end strong" : "label end", left - 10, y + 4,
                          Shorten(row.label, length)));
}

std::string BandHtml(const IntervalsSpec& spec, const Scale& x, const Box& box) {
  if (!std::isfinite(spec.low) || !std::isfinite(spec.high)) return "";
  return fmt::format(
      "<rect class=\"spread\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
      x(spec.low), box.top, std::max(x(spec.high) - x(spec.low), 1.0), box.bottom - box.top);
}

}  // namespace

std::string IntervalsHtml(const IntervalsSpec& spec) {
  const Range range = IntervalRange(spec);
  const std::string x_title = AxisTitle(spec.value);
  if (range.empty()) return Figure("plot", spec.title, "", "", NothingToPlot(), x_title);

  const bool labelled = spec.rows.size() <= kMostLabels;
  const double height = labelled ? kLabelled : kPlain;
  const Box box{LabelWidth(spec.rows), kTop, kFullWidth - 8,
                kTop + height * static_cast<double>(spec.rows.size())};
  const Scale x(range, box.left, box.right);
  std::string content = BandHtml(spec, x, box) + VerticalGrid(x, box, 8);
  for (std::size_t i = 0; i < spec.rows.size(); ++i) {
    const IntervalRow& row = spec.rows[i];
    const double y = box.top + height * (static_cast<double>(i) + 0.5);
    content += RowHtml(row, x, y, labelled ? 4 : 2.5);
    if (labelled || row.highlighted) content += LabelHtml(row, box.left, y);
  }
  content += MarksHtml(spec.marks, x, box);
  return Figure("plot", spec.title, "", "", Svg(kFullWidth, box.bottom + 24, spec.title, content),
                x_title);
}

}  // namespace continuum::page
