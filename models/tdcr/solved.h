#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/statics/solve_request.h"
#include "models/tdcr/calibrate.h"
#include "models/tdcr/measured.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// One row of the results before it is written.
struct Solved {
  std::string name;
  Loads loads;
  Solution solution;
  const Measured* measured = nullptr;
  int equilibrium = 0;              ///< of the case, counted from 1; 0: no list of them
  std::optional<double> miss = {};  ///< distance from a target [m]
};

/// Writes what the request asks for of all that was solved: results, shapes, compliance, figure.
/// prediction: how near the robot is to these results, where that is known.
/// @returns 0 when all of it was solved, else 1.
int Report(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& solved,
           const std::optional<Prediction>& prediction = {});

}  // namespace continuum::tdcr
