#pragma once

#include <vector>

#include "models/statics/solve_request.h"
#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/robot.h"

namespace continuum::twin_pivot {

/// Warns, each with its value and the plausible range, of what is in other units than SI: sizes,
/// stiffness and weights of the robot's file.
void WarnOfImplausibleRobot(const SolveRequest& request, const Robot& robot);

/// The same of tensions, lengths and dead loads of cases, against what would roll the robot up.
void WarnOfImplausibleCases(const SolveRequest& request, const Robot& robot,
                            const std::vector<Case>& cases);

}  // namespace continuum::twin_pivot
