#pragma once

#include <string>

#include "sim/page/page.h"

namespace continuum::page {

/// Inline SVG that shows without script. A plot without a finite value says so instead of staying
/// blank.
std::string ScatterHtml(const ScatterSpec& spec);
std::string BarsHtml(const BarsSpec& spec);
std::string HeatMapHtml(const HeatMapSpec& spec);

/// What stands in place of a plot that has nothing to show.
std::string NothingToPlot();

}  // namespace continuum::page
