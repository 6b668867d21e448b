#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "sim/page/plots.h"
#include "sim/page/svg.h"
#include "sim/page/text.h"

namespace continuum::page {
namespace {

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
