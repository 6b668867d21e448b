#pragma once

#include <string>

#include "sim/page/plot_spec.h"

namespace continuum::page {

/// Inline SVG that shows without script. A plot without a finite value says so instead of staying
/// blank.
std::string ScatterHtml(const ScatterSpec& spec);
std::string BarsHtml(const BarsSpec& spec);
std::string HeatMapHtml(const HeatMapSpec& spec);

}  // namespace continuum::page
