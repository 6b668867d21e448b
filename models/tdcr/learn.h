#pragma once

#include "models/statics/solve_request.h"
#include "models/tdcr/model.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {

/// `--calibrate`: writes the robot's file with the values that explain the measured shapes best.
/// @returns 1 when that is poor.
int CalibrateRobot(const SolveRequest& request, const Yaml& file, const Robot& robot,
                   Method method);
/// `--hybrid train`: writes the robot's file with a correction. @returns 1 when it is poor.
int TrainHybrid(const SolveRequest& request, const Yaml& file, const Robot& robot, Method method);

}  // namespace continuum::tdcr
