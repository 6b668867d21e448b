#include "sim/page/plots.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "error.h"
#include "sim/page/axis_scale.h"
#include "sim/page/text.h"

namespace continuum::page {
namespace {

constexpr double kFullWidth = 1060, kHalfWidth = 522, kThirdWidth = 345;

struct Box {
  double left, top, right, bottom;
};

std::string Svg(double width, double height, const std::string& title, const std::string& content) {
  return fmt::format("<svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\">\n{3}</svg>",
                     Compact(width), Compact(height), Escape(title), content);
}

std::string Line(const char* kind, double x1, double y1, double x2, double y2) {
  return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", kind, x1, y1, x2,
                     y2);
}

std::string Text(const std::string& classes, double x, double y, const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", classes, x, y,
                     Escape(text));
}

std::string VerticalGrid(const Scale& x, const Box& box, int count) {
  std::string out;
  for (const Tick& tick : Ticks(x.low(), x.high(), count)) {
    const double at = x(tick.value);
    out += Line(tick.value == 0 ? "zero" : "grid", at, box.top, at, box.bottom);
    out += Text("tick middle", at, box.bottom + 16, tick.text);
  }
  return out;
}

std::string HorizontalGrid(const Scale& y, const Box& box, int count) {
  std::string out;
  for (const Tick& tick : Ticks(y.low(), y.high(), count)) {
    const double at = y(tick.value);
    out += Line(tick.value == 0 ? "zero" : "grid", box.left, at, box.right, at);
    out += Text("tick end", box.left - 7, at + 4, tick.text);
  }
  return out;
}

void RequireSize(const std::string& title, const std::string& what, std::size_t expected,
                 std::size_t found) {
  if (expected == found) return;
  throw Error::Input(fmt::format("plot '{}', {}", title, what), fmt::format("{} values", expected),
                     std::to_string(found));
}

void CheckSizes(const ScatterSpec& spec) {
  for (const PointGroup& group : spec.groups) {
    RequireSize(spec.title, group.name, group.x.size(), group.y.size());
  }
  for (const Trend& trend : spec.trends) {
    RequireSize(spec.title, trend.name, trend.x.size(), trend.y.size());
    RequireSize(spec.title, trend.name + " (band)", trend.low.size(), trend.high.size());
    if (!trend.low.empty()) {
      RequireSize(spec.title, trend.name + " (band)", trend.x.size(), trend.low.size());
    }
  }
}

struct Ranges {
  Range x, y;
  std::size_t left_out = 0;
};

void AddPoint(double x, double y, Ranges& ranges) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  ranges.x.Add(x);
  ranges.y.Add(y);
}

Ranges Extent(const ScatterSpec& spec) {
  Ranges all;
  for (const PointGroup& group : spec.groups) {
    for (std::size_t i = 0; i < group.x.size(); ++i) {
      AddPoint(group.x[i], group.y[i], all);
      all.left_out += !std::isfinite(group.x[i]) || !std::isfinite(group.y[i]);
    }
  }
  for (const Trend& trend : spec.trends) {
    for (std::size_t i = 0; i < trend.x.size(); ++i) {
      AddPoint(trend.x[i], trend.y[i], all);
      if (trend.low.empty()) continue;
      AddPoint(trend.x[i], trend.low[i], all);
      AddPoint(trend.x[i], trend.high[i], all);
    }
  }
  return all;
}

// One path of dots. Dots that fall on the same half pixel are drawn once: the picture is the same
// and its size is bounded.
std::string Points(const PointGroup& group, const std::string& style, const Scale& x,
                   const Scale& y) {
  std::set<std::pair<long, long>> seen;
  std::string path;
  for (std::size_t i = 0; i < group.x.size(); ++i) {
    if (!std::isfinite(group.x[i]) || !std::isfinite(group.y[i])) continue;
    const std::pair dot(std::lround(2 * x(group.x[i])), std::lround(2 * y(group.y[i])));
    if (!seen.insert(dot).second) continue;
    path += fmt::format("M{:g} {:g}h0", 0.5 * static_cast<double>(dot.first),
                        0.5 * static_cast<double>(dot.second));
  }
  const char* density = seen.size() > 3000 ? "dense" : seen.size() > 400 ? "many" : "few";
  return fmt::format("<path class=\"dots {} {}\" d=\"{}\"/>\n", density, style, path);
}

// The stretches of a trend between non-finite entries.
std::vector<std::vector<std::size_t>> Stretches(const Trend& trend) {
  std::vector<std::vector<std::size_t>> out(1);
  for (std::size_t i = 0; i < trend.x.size(); ++i) {
    bool finite = std::isfinite(trend.x[i]) && std::isfinite(trend.y[i]);
    if (!trend.low.empty()) {
      finite = finite && std::isfinite(trend.low[i]) && std::isfinite(trend.high[i]);
    }
    if (finite) {
      out.back().push_back(i);
    } else if (!out.back().empty()) {
      out.emplace_back();
    }
  }
  return out;
}

std::string Band(const Trend& trend, const std::vector<std::size_t>& rows, const Scale& x,
                 const Scale& y) {
  std::string points;
  const auto add = [&](std::size_t i, double value) {
    points += fmt::format("{:.1f},{:.1f} ", x(trend.x[i]), y(value));
  };
  for (const std::size_t i : rows) add(i, trend.high[i]);
  for (auto i = rows.rbegin(); i != rows.rend(); ++i) add(*i, trend.low[*i]);
  return points;
}

std::string TrendHtml(const Trend& trend, const std::string& style, const Scale& x,
                      const Scale& y) {
  std::string out;
  for (const auto& rows : Stretches(trend)) {
    if (rows.empty()) continue;
    if (!trend.low.empty()) {
      out += fmt::format("<polygon class=\"area {}\" points=\"{}\"/>\n", style,
                         Band(trend, rows, x, y));
    }
    std::string path;
    for (const std::size_t i : rows) {
      path +=
          fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x(trend.x[i]), y(trend.y[i]));
    }
    if (rows.size() > 1) out += fmt::format("<path class=\"trend halo\" d=\"{}\"/>\n", path);
    // A single point shows through the round cap of a line without length.
    out += fmt::format("<path class=\"trend {}\" d=\"{}h0\"/>\n", style, path);
  }
  return out;
}

std::string ScatterLegend(const ScatterSpec& spec) {
  std::string out;
  std::size_t index = 0;
  for (const PointGroup& group : spec.groups) {
    out += LegendKey(group.name, StyleName(group.style, index++), "dot", false);
  }
  for (const Trend& trend : spec.trends) {
    const char* kind = trend.low.empty() ? "line" : "band";
    out += LegendKey(trend.name, StyleName(trend.style, index++), kind, false);
  }
  return out;
}

double ErrorOf(const Bar& bar) { return std::isfinite(bar.error) ? std::abs(bar.error) : 0; }

Range BarRange(const BarsSpec& spec) {
  Range range;
  for (const Bar& bar : spec.bars) {
    if (!std::isfinite(bar.value)) continue;
    range.Add(0);
    range.Add(bar.value - ErrorOf(bar));
    range.Add(bar.value + ErrorOf(bar));
  }
  if (range.empty()) return range;
  for (const Mark& mark : spec.marks) range.Add(mark.value);
  return range;
}

constexpr double kBarRow = 26, kBarTop = 24;

std::string ErrorHtml(double low, double high, double y) {
  return Line("error", low, y, high, y) + Line("error", low, y - 4, low, y + 4) +
         Line("error", high, y - 4, high, y + 4);
}

std::string BarShape(const Bar& bar, const Scale& x, double y) {
  if (!std::isfinite(bar.value)) return "";
  const double zero = x(0), tip = x(bar.value), error = ErrorOf(bar);
  const std::string shape = fmt::format(
      "<rect class=\"bar{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
      bar.highlighted ? " chosen" : "", std::min(zero, tip), y + 5,
      std::max(std::abs(tip - zero), 0.5), kBarRow - 10);
  if (error == 0) return shape;
  return shape + ErrorHtml(x(bar.value - error), x(bar.value + error), y + kBarRow / 2);
}

std::string BarText(const Bar& bar, const Scale& x, double left, double y) {
  const auto label_length = static_cast<std::size_t>((left - 12) / 7);
  const std::string label = fmt::format("<g><title>{}</title>{}</g>\n", Escape(bar.label),
                                        Text(bar.highlighted ? "label end strong" : "label end",
                                             left - 10, y + 17, Shorten(bar.label, label_length)));
  if (!std::isfinite(bar.value)) return label + Text("tick", x(0) + 6, y + 17, "no value");
  const double error = ErrorOf(bar);
  std::string value = Readable(bar.value);
  if (error > 0) value += " ± " + Readable(error, 2);
  if (bar.value < 0) return label + Text("value end", x(bar.value - error) - 6, y + 17, value);
  return label + Text("value", x(bar.value + error) + 6, y + 17, value);
}

std::string MarksHtml(const std::vector<Mark>& marks, const Scale& x, const Box& box) {
  std::string out;
  for (const Mark& mark : marks) {
    if (!std::isfinite(mark.value)) continue;
    const double at = x(mark.value), half = 3.3 * static_cast<double>(Length(mark.label));
    out += Line("mark", at, box.top, at, box.bottom);
    out += Text("mark-label middle", std::clamp(at, half, std::max(half, box.right - half)),
                box.top - 7, mark.label);
  }
  return out;
}

double LabelWidth(const BarsSpec& spec) {
  std::size_t longest = 4;
  for (const Bar& bar : spec.bars) longest = std::max(longest, Length(bar.label));
  return std::clamp(7.0 * static_cast<double>(longest) + 20, 80.0, 330.0);
}

struct HeatScale {
  double largest;
  bool diverging;
};

HeatScale HeatScaleOf(const HeatMapSpec& spec) {
  HeatScale scale{0, false};
  for (const auto& row : spec.values) {
    for (const double value : row) {
      if (!std::isfinite(value)) continue;
      scale.largest = std::max(scale.largest, std::abs(value));
      scale.diverging = scale.diverging || value < 0;
    }
  }
  if (scale.diverging) scale.largest = std::max(scale.largest, 1.0);
  return scale;
}

// Narrow cells drop a decimal and the zero before the point.
std::string CellText(double value, double cell) {
  const bool narrow = cell < 40;
  const double size = std::abs(value);
  std::string text = size >= 100 ? Compact(size, 3) : fmt::format("{:.{}f}", size, narrow ? 1 : 2);
  if (text.find_first_not_of("0.") == std::string::npos) return "0";
  if (narrow && text.starts_with("0.")) text.erase(0, 1);
  return value < 0 ? "−" + text : text;
}

std::string CellHtml(double value, const HeatScale& scale, double x, double y, double cell,
                     double height) {
  if (!std::isfinite(value)) return "";
  const double share = scale.largest > 0 ? std::abs(value) / scale.largest : 0;
  return fmt::format(
             "<rect class=\"cell {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
             "height=\"{:.1f}\" fill-opacity=\"{:.3g}\"/>\n",
             value < 0 ? "cold" : "hot", x, y, cell - 1, height - 1, share) +
         Text(share > 0.72 ? "cell-text middle strong" : "cell-text middle", x + cell / 2 - 0.5,
              y + height / 2 + 4, CellText(value, cell));
}

void CheckSizes(const HeatMapSpec& spec, std::size_t columns) {
  RequireSize(spec.title, "rows", spec.rows.size(), spec.values.size());
  for (std::size_t i = 0; i < spec.rows.size(); ++i) {
    RequireSize(spec.title, spec.rows[i], columns, spec.values[i].size());
  }
}

std::string HeatLegend(const HeatScale& scale) {
  const std::string low = scale.diverging ? Readable(-scale.largest) : "0";
  return fmt::format("<span class=\"ramp{}\"><b>{}</b><i></i><b>{}</b></span>",
                     scale.diverging ? " diverging" : "", low, Readable(scale.largest));
}

std::size_t LongestLabel(const std::vector<std::string>& labels) {
  std::size_t longest = 1;
  for (const std::string& label : labels) longest = std::max(longest, Length(label));
  return std::min<std::size_t>(longest, 28);
}

}  // namespace

std::string NothingToPlot() { return "<div class=\"nothing\">no finite value to plot</div>"; }

std::string ScatterHtml(const ScatterSpec& spec) {
  CheckSizes(spec);
  const Ranges extent = Extent(spec);
  const char* classes = spec.small ? "plot third" : spec.half_width ? "plot half" : "plot";
  const std::string x_title = AxisTitle(spec.x), y_title = AxisTitle(spec.y);
  if (extent.x.empty()) return Figure(classes, spec.title, "", y_title, NothingToPlot(), x_title);

  const double width = spec.small ? kThirdWidth : spec.half_width ? kHalfWidth : kFullWidth;
  const double height = spec.small ? 200 : 300;
  const int ticks = spec.small ? 4 : spec.half_width ? 6 : 10;
  const Box box{58, 6, width - 8, height - 24};
  const Scale x(extent.x, box.left, box.right), y(extent.y, box.bottom, box.top);
  std::string content = VerticalGrid(x, box, ticks) + HorizontalGrid(y, box, spec.small ? 4 : 6);
  std::size_t index = 0;
  for (const PointGroup& group : spec.groups) {
    content += Points(group, StyleName(group.style, index++), x, y);
  }
  for (const Trend& trend : spec.trends) {
    content += TrendHtml(trend, StyleName(trend.style, index++), x, y);
  }
  const std::string note = extent.left_out > 0
                               ? fmt::format("left out: {} without a finite value", extent.left_out)
                               : "";
  return Figure(classes, spec.title, ScatterLegend(spec), y_title,
                Svg(width, height, spec.title, content), x_title, note);
}

std::string BarsHtml(const BarsSpec& spec) {
  const Range range = BarRange(spec);
  const std::string x_title = AxisTitle(spec.value);
  if (range.empty()) return Figure("plot", spec.title, "", "", NothingToPlot(), x_title);

  const double rows = kBarRow * static_cast<double>(spec.bars.size());
  const Box box{LabelWidth(spec), kBarTop, kFullWidth - 8, kBarTop + rows};
  // Room for the printed values beyond the bars' ends.
  const double left = range.low() < 0 ? 90 : 0;
  const Scale x(range, box.left + left, box.right - 90, 0);
  std::string shapes, texts;
  for (std::size_t i = 0; i < spec.bars.size(); ++i) {
    const double y = box.top + kBarRow * static_cast<double>(i);
    shapes += BarShape(spec.bars[i], x, y);
    texts += BarText(spec.bars[i], x, box.left, y);
  }
  const std::string content =
      VerticalGrid(x, box, 8) + shapes + MarksHtml(spec.marks, x, box) + texts;
  return Figure("plot", spec.title, "", "", Svg(kFullWidth, box.bottom + 24, spec.title, content),
                x_title);
}

std::string HeatMapHtml(const HeatMapSpec& spec) {
  const std::vector<std::string>& columns = spec.columns.empty() ? spec.rows : spec.columns;
  CheckSizes(spec, columns.size());
  if (spec.rows.empty() || columns.empty()) {
    return Figure("plot", spec.title, "", "", NothingToPlot(), "");
  }
  const HeatScale scale = HeatScaleOf(spec);
  const double left = 7.0 * static_cast<double>(LongestLabel(spec.rows)) + 16;
  const double slant = 5.0 * static_cast<double>(LongestLabel(columns)) + 14;
  const double count = static_cast<double>(columns.size());
  const double cell = std::clamp((kFullWidth - left - slant) / count, 24.0, 64.0);
  const double height = std::min(cell, 34.0);
  std::string content;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const double x = left + cell * (static_cast<double>(j) + 0.5);
    content += fmt::format(
        "<text class=\"label\" transform=\"translate({:.1f} {:.1f}) "
        "rotate(-45)\">{}</text>\n",
        x, slant - 4, Escape(Shorten(columns[j], 28)));
  }
  for (std::size_t i = 0; i < spec.rows.size(); ++i) {
    const double y = slant + height * static_cast<double>(i);
    content += Text("label end", left - 8, y + height / 2 + 4, Shorten(spec.rows[i], 28));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      content +=
          CellHtml(spec.values[i][j], scale, left + cell * static_cast<double>(j), y, cell, height);
    }
  }
  const double width = std::max(kFullWidth, left + cell * count + slant);
  const double bottom = slant + height * static_cast<double>(spec.rows.size()) + 4;
  return Figure("plot", spec.title, HeatLegend(scale), "", Svg(width, bottom, spec.title, content),
                "");
}

}  // namespace continuum::page
