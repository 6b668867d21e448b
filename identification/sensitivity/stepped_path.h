#pragma once

#include <optional>
#include <vector>

#include "sim/simulation/simulate.h"

namespace continuum {

/// A machine with where its trial begins: positions, speeds, activations, states of effects.
struct PerturbedRun {
  ModelAndData machine;
  std::vector<double> q, v, w, z;
  /// Of a perturbed model whose difference has no closed form: its parameter moved the other way.
  ModelAndData mirrored = {};
};

/// One log simulated as MuJoCo steps it, with the traces of the perturbed models.
struct SteppedTraces {
  Trace trace;
  /// [perturbed model] to first order; none where it has no closed form.
  std::vector<std::optional<Trace>> perturbed;
};

/// Simulates one log by MuJoCo's steps, and along with it by StepSensitivity the perturbed models:
/// the same machine with one parameter moved by kPerturbation times its typical size
/// (identification/sensitivity/smooth_path.h). The model has no obstacle to StepSensitivity.
/// Without their traces where other rows of the constraint solver act on the way.
SteppedTraces SimulateStepped(PerturbedRun& trial, std::vector<PerturbedRun>& perturbed,
                              const Experiment& e, const Log& log);

}  // namespace continuum
