#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "identification/diagnosis/result.h"
#include "identification/fit/bounded_least_squares.h"
#include "identification/inverse_dynamics/missing_force.h"

namespace continuum {

/// What a candidate explains of the missing force, and where its fit may begin.
struct EquationStart {
  std::size_t start = 0;  ///< of the hypothesis, whose shape it has
  double share = 0;       ///< of the squares of the missing force
  /// Parameters of the base and of the candidate: those of the base as they were fitted without it,
  /// and as the missing force wants them beside it.
  Problem::Vector x, together;
};

/// A second view of the candidates, in which nothing is simulated for long: the missing force f at
/// the measured states (identification/inverse_dynamics/missing_force.h) as a sum of what the
/// fitted parameters p and one candidate do there,
///
///   f ≈ Σ a_i ∂f/∂p_i + b (f(p) − f(p, candidate)),   b ≥ 0,
///
/// by least squares over train logs, p within their bounds, every joint in units of its own missing
/// force. What drifts, swings out of phase or hides behind the time step in free simulation does
/// not here; noise of the accelerations does.
class EquationErrors {
 public:
  /// base: the problem without a candidate, fitted at x; use: logs.
  EquationErrors(const Problem& base, const Problem::Vector& x, std::vector<bool> use);

  /// Whether every joint is measured, so that there is anything to see.
  bool any() const { return force_.size() > 0; }
  /// The missing forces, and what the fitted parameters do there: the numbers of all joints below
  /// each other, each joint's rows in units of its own.
  const std::vector<MissingForce>& joints() const { return joints_; }
  const Problem::Vector& missing() const { return missing_; }
  const Problem::Matrix& columns() const { return columns_; }
  double unit(std::size_t joint) const { return units_.unit(joint); }
  /// What a candidate explains with sizes of its own, and where its fit may begin, in one shape:
  /// that of a start of the hypothesis. Effects are linear in their sizes here, however large they
  /// are. Nothing where it does nothing to f. problem: of the candidate.
  std::optional<EquationStart> From(const Hypothesis& hypothesis, const Problem& problem,
                                    std::size_t start) const;
  /// The same in the best of its shapes. first: what From finds in the first one, which explains
  /// something, or the others are not tried.
  EquationStart BestShape(const Hypothesis& hypothesis, const Problem& problem,
                          EquationStart first) const;
  /// Of a fitted candidate with the sizes that its fit gave it; nothing where it does nothing to f,
  /// as effects on the sensors.
  std::optional<ByEquation> Of(const CandidateResult& candidate) const;

 private:
  struct Solved {
    Problem::Vector x, sizes;  // p, and b of each column of a candidate
    Problem::Vector left;      // of the missing force
  };
  Solved Beside(const Problem::Matrix& D, const std::vector<int>& sign) const;
  /// Squares that the columns explain.
  double Amount(const Solved& s) const {
    return std::max(0.0, force_.squaredNorm() - s.left.squaredNorm());
  }
  std::vector<double> PerLog(const Problem::Vector& r) const;
  Problem::Vector Stacked(const Problem& problem, const Problem::Vector& x, double step = 0) const;
  /// What moving the parameters from x_, beside a candidate's own, does to f.
  Problem::Vector Change(const Problem& problem, const Problem::Vector& to) const;
  std::optional<EquationStart> AtShare(const Hypothesis& hypothesis, const Problem& problem,
                                       std::size_t start, double share) const;

  const Experiment& experiment_;
  Problem::Vector x_;
  std::vector<bool> use_;  // logs
  std::vector<MissingForce> joints_;
  StackedForces units_;
  std::vector<std::size_t> log_;  // of every number
  Problem::Vector missing_;       // f
  Problem::Vector coarse_;        // the same in steps of coarse_step_
  double coarse_step_ = 0;        // [s]
  Problem::Vector force_;         // f, less what the parameters explain of it
  Problem::Matrix columns_;       // [parameter] ∂f/∂p
  Box bounds_;                    // of the parameters
};

/// Whether the missing force speaks for another candidate than b: a explains it clearly better.
bool ClearlyBetterByEquation(const CandidateResult& a, const CandidateResult& b,
                             const Criteria& criteria = {});

}  // namespace continuum
