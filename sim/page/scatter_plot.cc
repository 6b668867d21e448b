#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "sim/page/axis_scale.h"
#include "sim/page/plots.h"
#include "sim/page/svg.h"
#include "sim/page/text.h"

namespace continuum::page {
namespace {

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

}  // namespace

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

}  // namespace continuum::page
