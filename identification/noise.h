#pragma once

#include <string>

#include "sim/score.h"

namespace continuum {

/// How large the measurement noise is, and how one knows.
struct Noise {
  double rms = 0;      ///< pooled unit; 0: not known
  double step = 0;     ///< what the model's own time step adds (h against h/4), pooled unit
  std::string source;  ///< "replicates", "sigma", "differences"
  std::size_t pairs = 0;
};

/// From replicates (logs of one trial, condition and set with the same rows): the differences
/// between them, in which model error cancels, over √2. Else from sigma where every output gives
/// it. Else from third differences of the measured rows (smooth motion cancels), a lower bound that
/// sees only white noise.
Noise NoiseOf(const Experiment& experiment);

/// The experiment with every log simulated at a fraction of the model's time step h.
Experiment WithStep(const Experiment& experiment, double step);

}  // namespace continuum
