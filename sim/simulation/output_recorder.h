#pragma once

#include <cstddef>

#include "sim/simulation/trace.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Records the sensors and actuator numbers that an experiment's outputs refer to, row by row.
class Recorder {
 public:
  Recorder(const mjModel& m, const Wiring& wiring, std::size_t rows);

  /// Reads the numbers of one row from d, after a forward pass or a step.
  void Take(const mjData& d, std::size_t row);
  /// Moves what was recorded into trace.raw and trace.axes; rows that were not recorded are NaN.
  void Release(Trace& trace);

 private:
  const mjModel& m_;
  const Wiring& wiring_;
  Trace::Raw raw_, axes_;
};

/// Whether a simulation has diverged: a warning of the engine about bad numbers, or a position that
/// is not finite.
bool Diverged(const mjModel& m, const mjData& d);

}  // namespace continuum
