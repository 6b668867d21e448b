#include "sim/page/svg.h"

#include <fmt/core.h>

#include "error.h"
#include "sim/page/text.h"

namespace continuum::page {

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

}  // namespace continuum::page
