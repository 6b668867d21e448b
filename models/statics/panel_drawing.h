#pragma once

#include <string>

#include "models/statics/figure_layout.h"

namespace continuum::statics {

/// Draws one view: grid, base, robots, forces, gravity, and the axes around them. Cases beyond
/// kMostNamed are lines with their tips. `letter` names the view.
void DrawPanel(const Figure& figure, const Layout& layout, const Panel& panel,
               const std::string& letter, Canvas& canvas);

}  // namespace continuum::statics
