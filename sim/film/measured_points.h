#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "sim/simulation/simulate.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// A marker whose position a log measures in two directions or all, in the world of the model [m].
/// In a direction that is not measured it is where the simulated one is.
struct MeasuredPoint {
  std::array<double, 3> measured, simulated;
  bool held = false;  ///< several rows are missing here, this one is of before or after
};

/// The row itself or, where it lies in a gap of up to half a second between two rows in which
/// something is measured, the nearer of the two.
struct MeasuredRow {
  std::size_t row;
  std::size_t gap;  ///< rows without, 0: the row itself
};
std::optional<MeasuredRow> FindMeasured(const Log& log, std::size_t row,
                                        const std::function<bool(std::size_t)>& measured);

/// The markers that a log sees at a row, and where a state of the model (of this row, evaluated)
/// has them: framepos outputs, without what their registration and measurement add.
std::vector<MeasuredPoint> MeasuredPoints(const Experiment& e, const Wiring& wiring, const Log& log,
                                          std::size_t row, const mjModel& m, const mjData& d);

}  // namespace continuum
