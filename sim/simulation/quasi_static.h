#pragma once

#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// How slowly a quasi-static simulation moves and when it takes the machine to be at rest. Times
/// are in time constants τ of the machine's slowest mode.
struct QuasiStaticOptions {
  double crossing_time = 50;  ///< for an input to cross the range that it has in the log
  double longest_wait = 500;  ///< that a row waits for rest after its ramp
  /// Largest |v| τ and |a| τ² of a joint at rest [rad or m].
  double rest = 1e-6;
  bool search = true;  ///< for rest without motion where that can be
};

/// Runs one log through a machine row by row, without real time.
///
/// From each row to the next all inputs move on straight lines (`interpolate` is of no account),
/// then the machine comes to rest, and there the outputs are read. Where smooth forces and constant
/// dry friction of joints are all that acts, rest is found from rest
/// (sim/simulation/rest_search.h), in steps of a twentieth of the inputs' ranges; else, and where
/// no rest is found so, by motion. What remembers the way (anchors of dry friction, cables that
/// stick, hysteresis) is kept from row to row. Lags and delays have always settled. The first row
/// follows on the experiment's start: under `start: rest` inputs move up from zero, else the
/// machine settles under them.
///
/// By motion: so that nothing swings past its stop, which would turn friction round, every mode of
/// the machine around its present state gets what it lacks to critical damping,
///
///   M a = f(q, v) − C v,   C = M V diag(c) Vᵀ M,   c_i = max(0, ω_i (2 − ω_i h) − d_i)      (1)
///
/// K V = M V diag(ω²), K and D = −∂f/∂q and −∂f/∂v by differences, d = diag(Vᵀ D V), h the time
/// step. C v is gone at rest, so it moves no rest that friction holds; while moving it is as small
/// as the ramp is slow (crossing). Modes slower than 5 s count as free.
///
/// A row that does not come to rest soon gets its modes anew and finer steps, down to h/8: a cable
/// that becomes taut stiffens a machine beyond what was measured before.
///
/// A row that finds no rest ends the simulation: diverged and why are set. Throws Error for effects
/// that creep: their rest is a matter of time.
Trace SimulateAtRest(ModelAndData& machine, const Experiment& e, const Log& log,
                     const InitialState& initial = {}, const Hooks& hooks = {},
                     const QuasiStaticOptions& = {});

}  // namespace continuum
