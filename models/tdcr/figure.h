#pragma once

#include "models/statics/figure.h"
#include "models/tdcr/measured.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// A figure of the robot without shapes and title.
statics::Figure EmptyFigure(const Robot& robot);

/// A solved case: rod, disks, tendons through their holes, tip force and gravity.
/// @param measured its measured disks, or null.
statics::Shape ShapeOf(const Robot& robot, const Loads& loads, const Solution& solution,
                       const Measured* measured);

}  // namespace continuum::tdcr
