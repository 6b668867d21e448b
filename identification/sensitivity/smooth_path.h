#pragma once

#include <memory>

#include "identification/sensitivity/continuous_dynamics.h"
#include "identification/sensitivity/cvodes.h"

namespace continuum {

/// What a flow and its neighbours say about the rows of one log.
struct SmoothTraces {
  Trace trace;
  std::vector<Trace> moved;  ///< [neighbour] to first order
  Cvodes::Work work;
};

/// Integrates a flow and its sensitivities. A neighbour k is the same machine with one parameter
/// moved by a little, δ_k: with s_k = ∂y/∂p_k δ_k/kMove,
///
///   ṡ_k = (f_k(t, y + kMove s_k) − f(t, y)) / kMove                             (1)
///
/// is ∂f/∂y s_k + ∂f/∂p_k to first order in kMove: one evaluation per parameter whatever the number
/// of states (internal numerical differentiation, bock1983). Neighbours should be kMove times the
/// typical size of their parameter away, so that errors of all s_k are weighed alike. A trace that
/// the solver could not follow is marked diverged.
SmoothTraces FollowFlow(ContinuousDynamics& flow,
                        const std::vector<std::unique_ptr<ContinuousDynamics>>& neighbours,
                        const Experiment& e, const Log& log, const SolverOptions& how);

/// Below, rounding shows in sensitivities; above, curvature does.
inline constexpr double kMove = 5e-7;

}  // namespace continuum
