#pragma once

#include <memory>

#include "identification/sensitivity/continuous_dynamics.h"
#include "identification/sensitivity/cvodes.h"

namespace continuum {

/// One log simulated on the smooth path, with the traces of the perturbed models.
struct SmoothTraces {
  Trace trace;
  std::vector<Trace> perturbed;  ///< [perturbed model] to first order
  Cvodes::Work work;
};

/// Simulates one log as a differential equation by CVODES, with sensitivities. Perturbed model k is
/// the same machine with one parameter moved by a little, δ_k: with s_k = ∂y/∂p_k δ_k/ε and ε =
/// kPerturbation,
///
///   ṡ_k = (f_k(t, y + ε s_k) − f(t, y)) / ε                                      (1)
///
/// is ∂f/∂y s_k + ∂f/∂p_k to first order in ε: one evaluation per parameter whatever the number of
/// states (internal numerical differentiation, bock1983). δ_k should be ε times the typical size of
/// the parameter, so that errors of all s_k are weighed alike. A trace that the solver could not
/// follow is marked diverged.
SmoothTraces SimulateSmooth(ContinuousDynamics& dynamics,
                            const std::vector<std::unique_ptr<ContinuousDynamics>>& perturbed,
                            const Experiment& e, const Log& log, const SolverOptions& how);

/// ε above: below it, rounding shows in sensitivities; above, curvature does.
inline constexpr double kPerturbation = 5e-7;

}  // namespace continuum
