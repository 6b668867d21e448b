#pragma once

#include <array>
#include <vector>

#include "sim/simulate.h"

namespace continuum {

/// A marker whose position a log measures in all three directions, in the world of the model [m].
struct MeasuredPoint {
  std::array<double, 3> measured, simulated;
};

/// The markers that a log sees at a row, and where a state of the model (of this row, evaluated)
/// has them: framepos outputs, without what their registration and measurement add.
std::vector<MeasuredPoint> MeasuredPoints(const Experiment& e, const Wiring& wiring, const Log& log,
                                          std::size_t row, const mjModel& m, const mjData& d);

}  // namespace continuum
