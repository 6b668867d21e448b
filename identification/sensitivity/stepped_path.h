#pragma once

#include <optional>
#include <vector>

#include "sim/simulation/simulate.h"

namespace continuum {

/// A machine with where its trial begins: positions, speeds and activations.
struct PerturbedRun {
  ModelAndData machine;
  std::vector<double> q, v, w;
};

/// What a machine and its neighbours say about the rows of one log, as MuJoCo steps them.
struct SteppedTraces {
  Trace trace;
  /// [neighbour] to first order; none where it has no closed form.
  std::vector<std::optional<Trace>> moved;
};

/// Steps a machine once, and with it by StepSensitivity its neighbours, which are the same machine
/// with one parameter moved by kMove times its typical size
/// (identification/sensitivity/smooth_path.h). The model has no obstacle to StepSensitivity.
/// Without traces of neighbours where other rows of the constraint solver act on the way.
SteppedTraces FollowSteps(PerturbedRun& trial, std::vector<PerturbedRun>& neighbours,
                          const Experiment& e, const Log& log);

}  // namespace continuum
