#pragma once

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// Reads `sections` and `tendons` of a robot's file. @throws Error with file, line and key for what
/// is missing, unknown or contradicts itself: a tendon outside its disks or inside the rod, one
/// that ends nowhere, disks beyond their section.
void ReadSections(const Yaml& file, Robot& robot);

}  // namespace continuum::tdcr
