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

}  // namespace

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

std::string BarsHtml(const BarsSpec& spec) {
  const Range range = BarRange(spec);
  const std::string x_title = AxisTitle(spec.value);
  if (range.empty()) return Figure("plot", spec.title, "", "", NothingToPlot(), x_title);

  const double rows = kBarRow * static_cast<double>(spec.bars.size());
  const Box box{LabelWidth(spec.bars), kBarTop, kFullWidth - 8, kBarTop + rows};
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

}  // namespace continuum::page
