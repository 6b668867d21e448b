#pragma once

#include <string>
#include <vector>

#include "sim/page/axis_scale.h"
#include "sim/page/plot_spec.h"
#include "sim/page/svg.h"

namespace continuum::page {

/// Inline SVG that shows without script. A plot without a finite value says so instead of staying
/// blank.
std::string ScatterHtml(const ScatterSpec& spec);
std::string BarsHtml(const BarsSpec& spec);
/// Vertical marks across a box, each with its label above it.
std::string MarksHtml(const std::vector<Mark>& marks, const Scale& x, const Box& box);
std::string IntervalsHtml(const IntervalsSpec& spec);
std::string HeatMapHtml(const HeatMapSpec& spec);

}  // namespace continuum::page
