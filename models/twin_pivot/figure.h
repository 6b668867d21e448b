#pragma once

#include "models/statics/figure.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// A figure of the robot without shapes and title.
statics::Figure EmptyFigure(const Robot& robot);

/// A solved case: rods, discs, cables through their holes, and at the tip the force and the weight
/// of the payload, and gravity. Moments at the tip are not drawn.
statics::Shape ShapeOf(const Robot& robot, const Load& load, const Solution& solution);

}  // namespace continuum::twin_pivot
