#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "sim/page/axis_scale.h"
#include "sim/page/text.h"

namespace continuum::page {

/// Widths of plots that take a row, a half or a third of it [px].
inline constexpr double kFullWidth = 1060, kHalfWidth = 522, kThirdWidth = 345;

/// The area inside the axes [px].
struct Box {
  double left, top, right, bottom;
};

/// An inline SVG of a size [px] around its content.
std::string Svg(double width, double height, const std::string& title, const std::string& content);

/// A straight line of a CSS class.
std::string Line(const char* kind, double x1, double y1, double x2, double y2);

/// Text at a point; it is escaped.
std::string Text(const std::string& classes, double x, double y, const std::string& text);

/// Grid lines with their numbers, about `count` of them.
std::string VerticalGrid(const Scale& x, const Box& box, int count);
std::string HorizontalGrid(const Scale& y, const Box& box, int count);

/// Throws Error (kInput) with the plot's title when two sizes that must agree do not.
void RequireSize(const std::string& title, const std::string& what, std::size_t expected,
                 std::size_t found);

/// Room [px] for the labels of rows on the left of a plot; a row has a `label`.
template <class Rows>
double LabelWidth(const Rows& rows) {
  std::size_t longest = 4;
  for (const auto& row : rows) longest = std::max(longest, Length(row.label));
  return std::clamp(7.0 * static_cast<double>(longest) + 20, 80.0, 330.0);
}

}  // namespace continuum::page
