#pragma once

#include <vector>

#include "models/statics/figure.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// A figure of the modules without shapes and title.
statics::Figure EmptyFigure(const ModuleSeries& series);

/// A solved case: the body along the axes of its modules [m], base to tip, their pressure lines,
/// the last mount with the force at its end, and gravity. The lines keep their distance from the
/// axis and do not twist.
statics::Shape ShapeOf(const ModuleSeries& series, Direction direction, const Case& row,
                       const Solution& solution, const std::vector<statics::Line>& axes);

}  // namespace continuum::stiff_flop
