#pragma once

#include <optional>
#include <vector>

#include "identification/diagnosis/result.h"
#include "identification/inverse_dynamics/missing_force.h"

namespace continuum {

/// A second view of the candidates, in which nothing is simulated for long: the missing force f at
/// the measured states (identification/inverse_dynamics/missing_force.h) as a sum of what the
/// fitted parameters p and one candidate do there,
///
///   f ≈ Σ a_i ∂f/∂p_i + b (f(p) − f(p, candidate)),   b ≥ 0,
///
/// by least squares over the train logs, every joint in units of its own missing force; the
/// candidate with the sizes that its fit gave it. What drifts, swings out of phase or hides behind
/// the time step in free simulation does not here; noise of the accelerations does.
class EquationErrors {
 public:
  /// base: the fitted model without a candidate.
  EquationErrors(const Experiment& experiment, const ModelSpec& system, const Fitted& base);

  /// Whether every joint is measured, so that there is anything to see.
  bool any() const { return force_.size() > 0; }
  /// Of a fitted candidate; nothing where it does nothing to f, as effects on the sensors.
  std::optional<ByEquation> Of(const CandidateResult& candidate) const;

 private:
  std::vector<double> PerLog(const Problem::Vector& r) const;
  Problem::Vector Stacked(const Problem& problem, const Problem::Vector& x) const;

  const Experiment& experiment_;
  Problem::Vector x_;
  StackedForces units_;
  std::vector<std::size_t> log_;  // of every number
  Problem::Vector missing_;       // f
  Problem::Vector force_;         // f, less what the parameters explain of it
  Problem::Matrix basis_;         // orthonormal, of what the parameters do
};

/// Whether the missing force speaks for another candidate than b: a explains it clearly better.
bool ClearlyBetterByEquation(const CandidateResult& a, const CandidateResult& b,
                             const Criteria& criteria = {});

}  // namespace continuum
