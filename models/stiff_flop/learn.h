#pragma once

#include "models/statics/solve_request.h"
#include "models/stiff_flop/case.h"

namespace continuum::stiff_flop {

/// `--calibrate`: writes the robot's file with E and gamma (or those of --parameters) that explain
/// the measured tips best. @returns 1 when that is poor.
int CalibrateRobot(const SolveRequest& request, const Robot& robot, const Method& method,
                   const Cases& cases);

}  // namespace continuum::stiff_flop
