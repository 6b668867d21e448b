#pragma once

#include <string>
#include <vector>

#include "sim/simulation/simulate.h"

namespace continuum {

/// A machine with where its trial begins: positions, speeds, activations, states of effects.
struct PerturbedRun {
  ModelAndData machine;
  std::vector<double> q, v, w, z;
  std::string field =
      {};  ///< of a perturbed model: what SingleSteps have to follow; empty: nothing
  ModelAndData mirrored = {};  ///< where there is such a field: its parameter moved the other way
};

/// One log simulated as MuJoCo steps it, with the traces of the perturbed models.
struct SteppedTraces {
  Trace trace;
  std::vector<Trace> perturbed;      ///< [perturbed model] to first order
  std::vector<std::string> why_not;  ///< [perturbed model] why it has none; empty: it has
};

/// Simulates one log by MuJoCo's steps, and along with it by StepSensitivity the perturbed models:
/// the same machine with one parameter moved by kPerturbation times its typical size
/// (identification/sensitivity/smooth_path.h). The model has no obstacle to StepSensitivity.
/// Without their traces where contacts act on the way.
SteppedTraces SimulateStepped(PerturbedRun& trial, std::vector<PerturbedRun>& perturbed,
                              const Experiment& e, const Log& log);

}  // namespace continuum
