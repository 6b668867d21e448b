#pragma once

#include <string>
#include <vector>

#include "sim/page/plot_spec.h"

namespace continuum {

struct ChartLine {
  enum class Kind { kLine, kDashed, kDots };
  std::string name;  ///< empty: not in the legend
  std::string colour;
  std::vector<double> x, y;  ///< finite
  Kind kind = Kind::kLine;
};

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<ChartLine> lines;
  bool square = false;  ///< one scale for both axes
  int columns = 6;      ///< about so many ticks along x
};

/// Charts side by side as an SVG file of its own, on a white ground. Throws Error (kInput) for a
/// line without points, or whose numbers of x and y differ.
std::string ChartsSvg(const std::vector<Chart>& charts);

}  // namespace continuum
