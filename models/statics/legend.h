#pragma once

#include "models/statics/figure_layout.h"

namespace continuum::statics {

/// Draws the column beside the views: a line for each case or, for many, the colour bar of their
/// loads; then what else is drawn, and the scale of the forces.
void DrawLegend(const Figure& figure, const Layout& layout, Canvas& canvas);

}  // namespace continuum::statics
