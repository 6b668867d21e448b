#pragma once

#include <vector>

#include "models/statics/solve_request.h"
#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// Warnings for values that no rod of this kind has: of the file, with key and line, and of the
/// cases, with column and line. A rod must fit between its tendons; a tension or force is judged by
/// the angle that it alone would bend the straight rod by.
void WarnOfImplausibleRobot(const SolveRequest& request, const Yaml& file, const Robot& robot);
void WarnOfImplausibleCases(const SolveRequest& request, const CsvTable& table, const Robot& robot,
                            const std::vector<Case>& cases);

}  // namespace continuum::tdcr
