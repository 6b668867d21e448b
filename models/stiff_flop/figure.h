#pragma once

#include <vector>

#include "models/statics/figure.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// A figure of the module without shapes and title.
statics::Figure EmptyFigure(const Module& module);

/// A solved case: the body along `axis` [m], base to tip, its pressure lines, the mount with the
/// force at its end, and gravity. The lines keep their distance from the axis and do not twist.
statics::Shape ShapeOf(const Module& module, Direction direction, const Case& row,
                       const Solution& solution, const std::vector<Eigen::Vector3d>& axis);

}  // namespace continuum::stiff_flop
