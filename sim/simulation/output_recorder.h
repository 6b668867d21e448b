#pragma once

#include <cstddef>

#include "sim/simulation/trace.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Collects what an experiment's outputs read, row by row.
class Recorder {
 public:
  Recorder(const mjModel& m, const Wiring& wiring, std::size_t rows);

  /// Reads d as a forward pass or a step has left it.
  void Take(const mjData& d, std::size_t row);
  /// Hands raw and axes over; what was not taken is NaN.
  void Release(Trace& trace);

 private:
  const mjModel& m_;
  const Wiring& wiring_;
  Trace::Raw raw_, axes_;
};

/// Whether a simulation still gives numbers.
bool Healthy(const mjModel& m, const mjData& d);

}  // namespace continuum
