#include "sim/page/chart.h"

#include <fmt/core.h>

#include "error.h"
#include "sim/page/axis_scale.h"
#include "sim/page/text.h"

namespace continuum {
namespace {

using page::Escape, page::Range, page::Scale, page::Tick;

constexpr double kWidth = 440, kPlot = 300, kLeft = 62, kTop = 34, kRight = 14;
constexpr double kLegendTop = kTop + kPlot + 58, kLegendRow = 18;
constexpr char kStyle[] =
    "text{font:13px sans-serif;fill:#222}.title{font-weight:bold}.tick{font-size:12px;fill:#555}"
    "path{fill:none;stroke-linejoin:round;stroke-linecap:round}.grid{stroke:#ddd}"
    ".frame{stroke:#888}.line{stroke-width:1.8}.dashed{stroke-width:1.6;stroke-dasharray:1 4}"
    ".dots{stroke-width:8}";

std::string Text(const char* kind, const char* anchor, double x, double y,
                 const std::string& text) {
  return fmt::format("<text class=\"{}\" text-anchor=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                     kind, anchor, x, y, Escape(text));
}

// A number of things has no unit.
std::string Title(const Axis& axis) {
  return axis.unit.empty() ? axis.label : page::AxisTitle(axis);
}

const char* NameOf(ChartLine::Kind kind) {
  return kind == ChartLine::Kind::kDots     ? "dots"
         : kind == ChartLine::Kind::kDashed ? "dashed"
                                            : "line";
}

std::string Stroke(const ChartLine& line, const std::string& path) {
  return fmt::format("<path class=\"{}\" stroke=\"{}\" d=\"{}\"/>\n", NameOf(line.kind),
                     Escape(line.colour), path);
}

struct Ranges {
  Range x, y;
};

// Widens a range around its middle.
void Widen(Range& range, double span) {
  const double middle = (range.low() + range.high()) / 2;
  range.Add(middle - span / 2), range.Add(middle + span / 2);
}

Ranges Extent(const Chart& chart) {
  Ranges all;
  for (const ChartLine& line : chart.lines) {
    for (const double x : line.x) all.x.Add(x);
    for (const double y : line.y) all.y.Add(y);
    if (line.x.empty() || line.x.size() != line.y.size())
      throw Error::Input("chart '" + chart.title + "'", "points on every line", line.name);
  }
  if (!chart.square) return all;
  const double wide = kWidth - kLeft - kRight;
  const double unit = std::max((all.x.high() - all.x.low()) / wide,  // per pixel
                               (all.y.high() - all.y.low()) / kPlot);
  Widen(all.x, unit * wide), Widen(all.y, unit * kPlot);
  return all;
}

std::string Grid(const Scale& x, const Scale& y, int columns) {
  const double right = kWidth - kRight, bottom = kTop + kPlot;
  std::string out;
  for (const Tick& tick : page::Ticks(x.low(), x.high(), columns)) {
    out +=
        fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/>\n", x(tick.value), kTop, bottom);
    out += Text("tick", "middle", x(tick.value), bottom + 17, tick.text);
  }
  for (const Tick& tick : page::Ticks(y.low(), y.high(), 6)) {
    out +=
        fmt::format("<path class=\"grid\" d=\"M{0} {1:.1f}H{2}\"/>\n", kLeft, y(tick.value), right);
    out += Text("tick", "end", kLeft - 6, y(tick.value) + 4, tick.text);
  }
  return out + fmt::format("<path class=\"frame\" d=\"M{0} {1}H{2}V{3}H{0}Z\"/>\n", kLeft, kTop,
                           right, bottom);
}

std::string LineHtml(const ChartLine& line, const Scale& x, const Scale& y) {
  const bool dots = line.kind == ChartLine::Kind::kDots;
  std::string path;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    path += fmt::format("{}{:.1f} {:.1f}{}", dots || i == 0 ? 'M' : 'L', x(line.x[i]), y(line.y[i]),
                        dots ? "h0" : "");
  }
  return Stroke(line, path);
}

std::string Legend(const Chart& chart) {
  std::string out;
  double row = kLegendTop;
  for (const ChartLine& line : chart.lines) {
    if (line.name.empty()) continue;
    const bool dot = line.kind == ChartLine::Kind::kDots;
    out += Stroke(line, fmt::format("M{} {}h{}", dot ? kLeft + 14 : kLeft, row - 4, dot ? 0 : 28));
    out += Text("name", "start", kLeft + 38, row, line.name);
    row += kLegendRow;
  }
  return out;
}

std::string ChartSvg(const Chart& chart) {
  const Ranges extent = Extent(chart);
  const double right = kWidth - kRight, bottom = kTop + kPlot;
  const Scale x(extent.x, kLeft, right), y(extent.y, bottom, kTop);
  std::string out =
      Text("title", "start", kLeft, kTop - 12, chart.title) + Grid(x, y, chart.columns);
  for (const ChartLine& line : chart.lines) out += LineHtml(line, x, y);
  out += Text("axis", "middle", (kLeft + right) / 2, bottom + 36, Title(chart.x));
  out += fmt::format("<g transform=\"translate(16 {}) rotate(-90)\">{}</g>\n", kTop + kPlot / 2,
                     Text("axis", "middle", 0, 0, Title(chart.y)));
  return out + Legend(chart);
}

}  // namespace

std::string ChartsSvg(const std::vector<Chart>& charts) {
  std::string content;
  double width = 0, height = kLegendTop;
  for (const Chart& chart : charts) {
    content += fmt::format("<g transform=\"translate({} 0)\">\n{}</g>\n", width, ChartSvg(chart));
    width += kWidth;
    double rows = 0;
    for (const ChartLine& line : chart.lines) rows += !line.name.empty();
    height = std::max(height, kLegendTop + kLegendRow * rows);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\">\n<style>{2}</style>\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n{3}</svg>\n",
      width, height, kStyle, content);
}

}  // namespace continuum
